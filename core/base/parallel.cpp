#include "core/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#ifdef FRETWORK_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace fretwork {
namespace {

/// What a loop promises about order, told to the thread sanitizer, which cannot see how the thread
/// library hands work over: all that precedes the loop comes before every chunk, and every chunk
/// before all that follows the loop. Nothing is said about two chunks, so that a race between them
/// is found. Empty in other builds.
class LoopOrder {
  public:
    /// Lives while one chunk runs, also when it ends by an exception.
    class Chunk {
      public:
        explicit Chunk(LoopOrder& loop) : loop_(loop) { loop_.acquire(&loop_.start_); }
        ~Chunk() { loop_.release(&loop_.end_); }
        Chunk(const Chunk&) = delete;
        Chunk& operator=(const Chunk&) = delete;

      private:
        LoopOrder& loop_;
    };

    LoopOrder() { release(&start_); }
    ~LoopOrder() { acquire(&end_); }
    LoopOrder(const LoopOrder&) = delete;
    LoopOrder& operator=(const LoopOrder&) = delete;

  private:
#ifdef FRETWORK_THREAD_SANITIZER
    static void acquire(void* edge) {
        __tsan_acquire(edge);
    }
    static void release(void* edge) {
        __tsan_release(edge);
    }
#else
    static void acquire(void* /*edge*/) {}
    static void release(void* /*edge*/) {}
#endif
    // Only the addresses matter; eight bytes each, the grain at which the sanitizer tells them apart.
    alignas(8) char start_[8] = {};
    alignas(8) char end_[8] = {};
};

}  // namespace

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
    LoopOrder order;
    tbb::parallel_for(std::size_t{0}, chunks, [&](std::size_t c) {
        const LoopOrder::Chunk running(order);
        body(c * grain, std::min(count, (c + 1) * grain));
    });
}

}  // namespace fretwork
