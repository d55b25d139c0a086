#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <thread>
#include <vector>

#include "core/base/counter_random.h"
#include "core/base/detached.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/run_control.h"
#include "core/base/words.h"

namespace fretwork {
namespace {

TEST_CASE("counter_random: numbers of neighbouring counters do not collide and fill the interval evenly", "[base]") {
    std::set<std::uint64_t> seen;
    double sum = 0.0;
    double sum_of_squares = 0.0;
    const int n = 4096;
    for (int i = 0; i < n; ++i) {
        const auto bits = counter_random(7, RandomStream::kTest, static_cast<std::uint32_t>(i % 4),
                                         static_cast<std::uint64_t>(i / 16), static_cast<std::uint32_t>(i / 4 % 4));
        seen.insert(bits);
        const double x = unit_interval(bits);
        CHECK(x >= 0.0);
        CHECK(x < 1.0);
        sum += x;
        sum_of_squares += x * x;
    }
    CHECK(seen.size() == static_cast<std::size_t>(n));
    // A uniform variable has mean 1/2 and mean square 1/3; five standard errors of 4096 draws.
    CHECK(sum / n == Approx(0.5).margin(5 * std::sqrt(1.0 / 12.0 / n)));
    CHECK(sum_of_squares / n == Approx(1.0 / 3.0).margin(5 * std::sqrt(4.0 / 45.0 / n)));
}

TEST_CASE("counter_random: an item draws the numbers that are counted for it", "[base]") {
    const ItemRandom item(9, RandomStream::kTest, 4, 77);
    for (std::uint32_t n = 0; n < 5; ++n) CHECK(item.draw(n) == counter_random(9, RandomStream::kTest, 4, 77, n));
    CHECK(item.draw(0) != item.draw(1));
}

TEST_CASE("counter_random: index_below reaches every index and no other", "[base]") {
    std::vector<int> hits(10, 0);
    for (std::uint32_t i = 0; i < 2000; ++i)
        ++hits.at(index_below(counter_random(1, RandomStream::kTest, 0, i, 0), 10));
    for (const int h : hits) CHECK(h > 0);
}

TEST_CASE("parallel: every index is visited once and sums do not depend on the threads", "[base]") {
    const std::size_t count = 10007;
    const auto term = [](std::size_t i) { return 1.0 / (1.0 + static_cast<double>(i)); };
    double reference = 0.0;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        std::vector<int> visits(count, 0);
        parallel_for(count, 64, [&](std::size_t i) { ++visits[i]; });
        CHECK(visits == std::vector<int>(count, 1));
        const double sum = sum_in_fixed_order(count, 64, 0.0, term);
        if (threads == 1) reference = sum;
        CHECK(sum == reference);
    }
}

TEST_CASE("parallel: an exception in a chunk reaches the caller", "[base]") {
    CHECK_THROWS_AS(parallel_for(1000, 8,
                                 [](std::size_t i) {
                                     if (i == 500) throw InvalidInput("five hundred");
                                 }),
                    InvalidInput);
}

TEST_CASE("RunControl: slices map to the whole and a stop request is honoured", "[base]") {
    std::stop_source source;
    std::vector<double> seen;
    const RunControl run([&](std::string_view, double f) { seen.push_back(f); }, source.get_token());
    run.slice(0.5, 1.0).slice(0.0, 0.5).checkpoint("stage", 1.0);
    run.checkpoint("stage", 2.0);
    CHECK(seen == std::vector<double>{0.75, 1.0});
    source.request_stop();
    CHECK_THROWS_AS(run.checkpoint("stage", 0.0), Cancelled);
    CHECK_THROWS_AS(run.slice(0, 0.1).throw_if_stopped(), Cancelled);
}

TEST_CASE("words between commas: without the blanks around them, and no empty ones", "[base]") {
    using Words = std::vector<std::string>;
    CHECK(words_between_commas("a, b c,,d ") == Words{"a", "b c", "d"});
    CHECK(words_between_commas(" , ,").empty());
    CHECK(words_between_commas("").empty());
    CHECK(words_between_commas("x") == Words{"x"});
}

TEST_CASE("detached work: hands on its result and its exception", "[base]") {
    CHECK(run_detached([] { return 42; }, {}) == 42);
    CHECK(*run_detached([] { return std::make_unique<int>(7); }, {}) == 7);
    CHECK_THROWS_AS(wait_detached([] { throw InvalidInput("broken"); }, {}), InvalidInput);
}

TEST_CASE("detached work: is left behind with all it owns when asked to stop", "[base]") {
    struct Owned {
        std::atomic<bool> may_end = false, ended = false;
    };
    const auto owned = std::make_shared<Owned>();
    std::stop_source source;
    std::thread asking([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));
        source.request_stop();
    });
    CHECK_THROWS_AS(wait_detached(
                        [owned] {
                            while (!owned->may_end) std::this_thread::yield();
                            owned->ended = true;
                        },
                        RunControl({}, source.get_token())),
                    Cancelled);
    asking.join();
    CHECK_FALSE(owned->ended);
    CHECK(owned.use_count() == 2);  // the work still holds it
    CHECK(detached_work_runs());
    owned->may_end = true;
    for (int turn = 0; turn < 1000 && owned.use_count() > 1; ++turn)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK(owned->ended);
    CHECK(owned.use_count() == 1);
    for (int turn = 0; turn < 1000 && detached_work_runs(); ++turn)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK_FALSE(detached_work_runs());
}

}  // namespace
}  // namespace fretwork
