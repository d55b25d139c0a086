// A vector for large arrays that are filled in parallel right after they are made.
#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace fretwork {

/// Memory for `bytes` bytes, from the start of a cache line on. Large blocks are laid on large pages where the system
/// has them, which makes both the first touch and random access cheaper. Release with `release_bulk` and the same
/// number. \throws std::bad_alloc
[[nodiscard]] void* allocate_bulk(std::size_t bytes);
void release_bulk(void* block, std::size_t bytes) noexcept;

/// Allocator that leaves new elements of a `resize` uninitialised, so that the pages of a large array are
/// first touched by the threads that fill it.
template <class T>
struct UninitializedAllocator : std::allocator<T> {
    template <class U>
    struct rebind {  // NOLINT(readability-identifier-naming): the name that allocators must have
        using other = UninitializedAllocator<U>;
    };

    UninitializedAllocator() = default;
    template <class U>
    UninitializedAllocator(const UninitializedAllocator<U>&) noexcept {}

    [[nodiscard]] T* allocate(std::size_t count) {
        if (count > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(allocate_bulk(count * sizeof(T)));
    }
    void deallocate(T* block, std::size_t count) noexcept { release_bulk(block, count * sizeof(T)); }

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
