// What a carved package says about the run that made it.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fretwork {

/// A part beside the model, found through a relationship of the package.
struct RecordPart {
    std::string path;           ///< "/Metadata/fretwork.toml"
    std::string_view relation;  ///< its type
    std::string bytes;
};

struct PackageRecord {
    /// A name without a prefix must be one of the core specification ("Designer", "LicenseTerms" ...); ours start
    /// with "fw:".
    std::vector<std::pair<std::string, std::string>> metadata;
    std::string spec_toml;               ///< resolved; empty: no such part
    std::string report_json;             ///< empty: no such part
    std::vector<RecordPart> more_parts;  ///< what it takes to run again
    std::string thumbnail_png;           ///< empty: none
};

/// The record's own parts, without the thumbnail, in the order in which they are written.
std::vector<RecordPart> parts_of(const PackageRecord& record);

/// All metadata, with spec and report where readers can bear them.
std::vector<std::pair<std::string, std::string>> metadata_of(const PackageRecord& record);

/// "toml" -> "application/toml"; "application/octet-stream" for what is not known.
std::string_view content_type_of(std::string_view extension);

/// "stl" of "/Metadata/fretwork/source.stl"
std::string_view extension_of(std::string_view path);

}  // namespace fretwork
