// Parts -> ZIP archive in memory.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "formats/deflated_part.h"

namespace fretwork {

/// The same parts in the same order give the same bytes: no clock, time zone or user enters.
class ZipWriter {
  public:
    ZipWriter();
    ~ZipWriter();
    ZipWriter(const ZipWriter&) = delete;
    ZipWriter& operator=(const ZipWriter&) = delete;

    /// Text to be packed.
    void add(std::string_view name, std::string_view text);

    /// Bytes that are packed already (PNG), kept as they are.
    void add_stored(std::string_view name, std::string bytes);

    void add_deflated(std::string_view name, DeflatedPart part);

    /// A part of another archive, not unpacked on the way.
    void add_packed(std::string_view name, PackedPart part);

    /// The archive. Call once, last. \throws SolverFailure  the archive cannot be put together.
    [[nodiscard]] std::string finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
