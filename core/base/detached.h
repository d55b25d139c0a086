// Work that cannot be interrupted, on a thread that can be left behind.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>

#include "core/base/run_control.h"

namespace fretwork {

/// Calls `work()` on another thread and waits for it; what it throws is passed on. A stop request ends the waiting
/// within 50 ms, while the work runs to its end unseen: it must own whatever it touches.
/// \throws Cancelled  `run` asked to stop.
void wait_detached(std::function<void()> work, const RunControl& run);

/// Whether work that was left behind still runs. A program that ends meanwhile must leave by `_exit`: libraries that
/// take themselves down at exit would pull the ground from under it.
[[nodiscard]] bool detached_work_runs();

/// `wait_detached` for work with a result.
/// \param work  copyable; holds what it needs by value or shared pointer
template <class Work>
auto run_detached(Work work, const RunControl& run) {
    using Result = std::invoke_result_t<Work&>;
    const auto result = std::make_shared<std::optional<Result>>();
    wait_detached([work = std::move(work), result]() mutable { result->emplace(work()); }, run);
    return std::move(**result);
}

}  // namespace fretwork
