#include "formats/deflated_part.h"

#include <zlib.h>

#include <new>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

/// Numbers pack to about a fifth at any level: the default one takes four times as long for 15 % in size.
constexpr int kLevel = 2;

/// Every piece ends on a byte border with an empty stored block, which lets raw streams be joined;
/// the last one ends the stream.
std::string deflate_raw(const std::string& text, bool last) {
    z_stream stream{};
    if (deflateInit2(&stream, kLevel, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
    std::string packed(deflateBound(&stream, static_cast<uLong>(text.size())) + 16, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));  // Read only; zlib predates const.
    stream.avail_in = static_cast<uInt>(text.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    const int result = deflate(&stream, last ? Z_FINISH : Z_SYNC_FLUSH);
    packed.resize(stream.total_out);
    const bool whole = stream.avail_in == 0 && result == (last ? Z_STREAM_END : Z_OK);
    deflateEnd(&stream);
    if (!whole)
        throw SolverFailure("deflate: a piece of " + std::to_string(text.size()) + " bytes was not packed whole");
    packed.shrink_to_fit();
    return packed;
}

}  // namespace

DeflatedPart deflate_pieces(std::size_t count, const std::function<std::string(std::size_t)>& piece,
                            const RunControl& run) {
    struct Checksum {
        std::size_t size = 0;
        uLong crc = 0;
    };
    std::vector<Checksum> checksums(count);
    DeflatedPart part;
    part.blocks.resize(count);
    parallel_for(count, 1, [&](std::size_t i) {
        run.throw_if_stopped();
        const std::string text = piece(i);
        checksums[i] = {text.size(),
                        ::crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()))};
        part.blocks[i] = deflate_raw(text, i + 1 == count);
    });
    uLong crc = ::crc32(0, nullptr, 0);
    for (const Checksum& sum : checksums) {
        part.size += sum.size;
        crc = crc32_combine(crc, sum.crc, static_cast<z_off_t>(sum.size));
    }
    part.crc32 = static_cast<std::uint32_t>(crc);
    return part;
}

std::uint64_t DeflatedPart::packed_size() const {
    std::uint64_t sum = 0;
    for (const std::string& block : blocks) sum += block.size();
    return sum;
}

}  // namespace fretwork
