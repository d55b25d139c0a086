#include "core/base/detached.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace fretwork {
namespace {

std::atomic<int> running = 0;  // in the whole process

struct Outcome {
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    std::exception_ptr failure;
};

}  // namespace

bool detached_work_runs() {
    return running > 0;
}

void wait_detached(std::function<void()> work, const RunControl& run) {
    run.throw_if_stopped();
    const auto outcome = std::make_shared<Outcome>();
    ++running;
    std::thread([outcome, work = std::move(work)]() mutable {
        std::exception_ptr failure;
        try {
            work();
        } catch (...) {
            failure = std::current_exception();
        }
        work = nullptr;  // what it owns goes before anybody hears of the end
        --running;
        const std::lock_guard lock(outcome->mutex);
        outcome->failure = failure;
        outcome->done = true;
        outcome->changed.notify_all();
    }).detach();
    std::unique_lock lock(outcome->mutex);
    while (!outcome->changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return outcome->done; }))
        run.throw_if_stopped();
    if (outcome->failure) std::rethrow_exception(outcome->failure);
}

}  // namespace fretwork
