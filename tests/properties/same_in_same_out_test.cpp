// Promises 6 and 8 on the whole flow: the same result on any number of threads, progress that rises, a prompt stop.
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <stop_token>
#include <thread>

#include "core/base/error.h"
#include "properties/carve_cases.h"

namespace fretwork::testing {
namespace {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST_CASE("carve: the same bytes on 1, 2 and 4 threads, and again", "[property]") {
    const auto models = property_models();
    const auto m = GENERATE(0, 3, 6);
    const PropertyModel& model = models.at(static_cast<std::size_t>(m));
    CAPTURE(model.name);
    const CarveResult one = carve_model(model, "waves", 11, 1);
    for (const int threads : {2, 4}) {
        CAPTURE(threads);
        const CarveResult many = carve_model(model, "waves", 11, threads);
        CHECK(same_bytes(one.carved.mesh.positions_mm, many.carved.mesh.positions_mm));
        CHECK(one.carved.mesh.triangles == many.carved.mesh.triangles);
        CHECK(one.carved.triangle_colors == many.carved.triangle_colors);
        CHECK(one.solid == many.solid);
        CHECK(one.reinforced == many.reinforced);
        CHECK(one.voxel_colors == many.voxel_colors);
    }
    const CarveResult other = carve_model(model, "waves", 12, 2);
    CHECK(one.solid != other.solid);
}

TEST_CASE("carve: progress never falls and ends at one", "[property]") {
    double last = 0.0;
    bool fell = false;
    const RunControl run([&](std::string_view, double fraction) {
        fell = fell || fraction < last;
        last = fraction;
    });
    carve_model(property_models().at(0), "cells", 1, 2, run);
    CHECK_FALSE(fell);
    CHECK(last == 1.0);
}

TEST_CASE("carve: a stop at any moment ends the run at once", "[property]") {
    const PropertyModel model = property_models().at(2);
    const auto begin = std::chrono::steady_clock::now();
    carve_model(model, "zebra", 1);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;

    int cancelled = 0;
    for (const double share : {0.02, 0.1, 0.25, 0.45, 0.65, 0.85}) {
        CAPTURE(share);
        std::stop_source source;
        const RunControl run({}, source.get_token());
        std::jthread stopper([&] {
            std::this_thread::sleep_for(share * whole);
            source.request_stop();
        });
        // A run that was faster than the first one may end before the stop.
        try {
            carve_model(model, "zebra", 1, 0, run);
        } catch (const Cancelled&) {
            ++cancelled;
        }
    }
    CHECK(cancelled >= 3);
}

}  // namespace
}  // namespace fretwork::testing
