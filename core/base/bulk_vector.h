// A vector for large arrays that are filled in parallel right after they are made.
#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace fretwork {

/// Allocator that leaves new elements of a `resize` uninitialised, so that the pages of a large array are
/// first touched by the threads that fill it.
template <class T>
struct UninitializedAllocator : std::allocator<T> {
    template <class U>
    struct rebind {
        using other = UninitializedAllocator<U>;
    };

    template <class U, class... Arguments>
    void construct(U* place, Arguments&&... arguments) {
        if constexpr (sizeof...(Arguments) == 0)
            ::new (static_cast<void*>(place)) U;
        else
            ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
};

/// A std::vector whose `resize` leaves numbers uninitialised: every element must be written before it is read.
template <class T>
using BulkVector = std::vector<T, UninitializedAllocator<T>>;

}  // namespace fretwork
