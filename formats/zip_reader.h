// ZIP archive in memory -> its parts. Guards against archives made to do harm.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "formats/deflated_part.h"

namespace fretwork {

struct ZipLimits {
    std::size_t max_entries = 20000;
    std::uint64_t max_part_bytes = std::uint64_t{4} << 30;  ///< unpacked
    /// Unpacked size over packed size, for parts over 1 MiB and for the whole archive.
    std::uint64_t max_ratio = 200;
};

/// Names of parts are as they stand in the archive ("3D/3dmodel.model"), told apart without regard to
/// case as the package format asks. Nothing is ever written to disk. The bytes must outlive the reader.
class ZipReader {
  public:
    struct Entry {
        std::string name;
        std::uint64_t size = 0;  ///< unpacked
    };

    /// \throws InvalidInput  no ZIP; cut off; more entries or a higher ratio than the limits; two entries
    ///                       of one name; a name that is absolute, has a drive, backslash, control
    ///                       character or "..", a symbolic link; encryption; a method that is neither
    ///                       stored nor deflate. Names the entry.
    ZipReader(std::string_view bytes, std::string_view source, const ZipLimits& limits = {});
    ~ZipReader();
    ZipReader(ZipReader&&) noexcept;
    ZipReader& operator=(ZipReader&&) noexcept;

    /// Files in the order of the archive; folders are left out.
    [[nodiscard]] const std::vector<Entry>& entries() const;

    [[nodiscard]] bool contains(std::string_view name) const;

    /// The whole part. \throws InvalidInput  no such part, broken data, wrong checksum or size, over `max_bytes`.
    [[nodiscard]] std::string read(std::string_view name, std::uint64_t max_bytes) const;

    /// The part as it lies in the archive; neither unpacked nor checked. \throws InvalidInput  no such part, cut off.
    [[nodiscard]] PackedPart read_packed(std::string_view name) const;

    /// Hands the part to `take` block by block, checked as it goes; the checksum is known to be right
    /// when the call returns. The next block is unpacked on another thread meanwhile; `take` may read other parts.
    void read_blocks(std::string_view name, const std::function<void(std::string_view block)>& take) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
