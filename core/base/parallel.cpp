#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "core/base/thread_order.h"

namespace fretwork {

ThreadLimit::ThreadLimit(int threads) : control_(nullptr) {
    const std::size_t limit = threads > 0 ? static_cast<std::size_t>(threads)
                                          : static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
    control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism, limit);
}

ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t begin, std::size_t end)>& body) {
    if (count == 0) return;
    const std::size_t chunks = (count + grain - 1) / grain;
    if (chunks == 1) {
        body(0, count);
        return;
    }
    ThreadOrder order;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
        const ThreadOrder::Task running(order);
        body(c * grain, std::min(count, (c + 1) * grain));
    });
}

}  // namespace fretwork
