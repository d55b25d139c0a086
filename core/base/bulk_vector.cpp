#include "core/base/bulk_vector.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

#include <new>

namespace fretwork {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kLargePage = std::size_t{1} << 21;
// Blocks of at least this many bytes are worth whole large pages.
constexpr std::size_t kLargeBlock = 4 * kLargePage;

}  // namespace

void* allocate_bulk(std::size_t bytes) {
    if (bytes < kLargeBlock) return ::operator new (bytes, std::align_val_t{kCacheLine});
    void* block = ::operator new (bytes, std::align_val_t{kLargePage});
#ifdef __linux__
    // A wish only: where it is not granted, ordinary pages serve as well.
    static_cast<void>(madvise(block, bytes, MADV_HUGEPAGE));
#endif
    return block;
}

void release_bulk(void* block, std::size_t bytes) noexcept {
    if (bytes < kLargeBlock)
        ::operator delete (block, std::align_val_t{kCacheLine});
    else
        ::operator delete (block, std::align_val_t{kLargePage});
}

}  // namespace fretwork
