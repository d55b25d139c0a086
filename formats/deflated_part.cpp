#include "formats/deflated_part.h"

#include <zlib.h>

#include <new>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

/// Numbers pack to about a fifth at any level; beyond this one the time doubles for 3 % in size.
constexpr int kLevel = 4;

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
    struct Packed {
        std::string bytes;
        std::size_t size = 0;
        uLong crc = 0;
    };
    std::vector<Packed> packed(count);
    parallel_for(count, 1, [&](std::size_t i) {
        run.throw_if_stopped();
        const std::string text = piece(i);
        packed[i].size = text.size();
        packed[i].crc = ::crc32(0, reinterpret_cast<const Bytef*>(text.data()), static_cast<uInt>(text.size()));
        packed[i].bytes = deflate_raw(text, i + 1 == count);
    });
    DeflatedPart part;
    std::size_t total = 0;
    for (const Packed& p : packed) total += p.bytes.size();
    part.bytes.reserve(total);
    uLong crc = ::crc32(0, nullptr, 0);
    for (Packed& p : packed) {
        part.bytes += p.bytes;
        std::string().swap(p.bytes);
        part.size += p.size;
        crc = crc32_combine(crc, p.crc, static_cast<z_off_t>(p.size));
    }
    part.crc32 = static_cast<std::uint32_t>(crc);
    return part;
}

}  // namespace fretwork
