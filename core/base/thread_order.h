// Work on the threads of a library, in an order that the thread sanitizer can see.
#pragma once

#if defined(__SANITIZE_THREAD__) || defined(FRETWORK_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#define FRETWORK_ORDERS_THREADS 1
#endif

namespace fretwork {

/// Lives around a call that hands work to threads of a library and waits for it. The thread sanitizer
/// cannot see how such a library, which is not instrumented, orders that work; this states what the
/// call promises: all that precedes it comes before every task, and every task before all that follows
/// it. Nothing is said about two tasks, so that a race between them is found. Empty in other builds.
class ThreadOrder {
  public:
    /// Lives while one task runs, also when it ends by an exception.
    class Task {
      public:
        explicit Task(ThreadOrder& order) : order_(order) { acquire(&order_.start_); }
        ~Task() { release(&order_.end_); }
        Task(const Task&) = delete;
        Task& operator=(const Task&) = delete;

      private:
        ThreadOrder& order_;
    };

    ThreadOrder() { release(&start_); }
    ~ThreadOrder() { acquire(&end_); }
    ThreadOrder(const ThreadOrder&) = delete;
    ThreadOrder& operator=(const ThreadOrder&) = delete;

  private:
#ifdef FRETWORK_ORDERS_THREADS
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

}  // namespace fretwork
