// Threads behind one header. The only place where the thread library appears is parallel.cpp.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace fretwork {

/// Limits the threads of all parallel loops while it lives. `threads` = 0 means one per core.
class ThreadLimit {
  public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

  private:
    void* control_;
};

/// Calls `body(begin, end)` for chunks that cover [0, count). Chunks start at multiples of `grain`
/// and hold at most `grain` items, whatever the number of threads, so that a result that is made
/// per chunk and joined in order of chunks is the same on every run.
/// An exception from `body` is passed on after the running chunks have ended.
void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls `body(i)` for every i in [0, count); order and thread are unspecified.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
    parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Sum of `term(i)` over [0, count), added in an order that depends on `grain` alone.
template <class Sum, class Term>
Sum sum_in_fixed_order(std::size_t count, std::size_t grain, Sum zero, const Term& term) {
    std::vector<Sum> partial((count + grain - 1) / grain, zero);
    parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
        Sum sum = zero;
        for (std::size_t i = begin; i < end; ++i) sum += term(i);
        partial[begin / grain] = sum;
    });
    Sum total = zero;
    for (const Sum& part : partial) total += part;
    return total;
}

}  // namespace fretwork
