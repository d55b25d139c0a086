#include "formats/package_record.h"

#include "formats/threemf_names.h"

namespace fretwork {
namespace {

// Longer texts are in their own parts only: readers limit what an element may hold.
constexpr std::size_t kMostMetadataBytes = 1 << 18;

}  // namespace

std::vector<RecordPart> parts_of(const PackageRecord& record) {
    std::vector<RecordPart> parts;
    if (!record.spec_toml.empty())
        parts.push_back({"/Metadata/fretwork.toml", threemf::kSpecRelation, record.spec_toml});
    if (!record.report_json.empty())
        parts.push_back({"/Metadata/fretwork.json", threemf::kReportRelation, record.report_json});
    parts.insert(parts.end(), record.more_parts.begin(), record.more_parts.end());
    return parts;
}

std::vector<std::pair<std::string, std::string>> metadata_of(const PackageRecord& record) {
    std::vector<std::pair<std::string, std::string>> all = record.metadata;
    const auto add = [&](const char* name, const std::string& text) {
        if (!text.empty() && text.size() < kMostMetadataBytes) all.emplace_back(name, text);
    };
    add("fw:spec", record.spec_toml);
    add("fw:report", record.report_json);
    return all;
}

std::string_view content_type_of(std::string_view extension) {
    static constexpr std::pair<std::string_view, std::string_view> kTypes[] = {
        {"rels", "application/vnd.openxmlformats-package.relationships+xml"},
        {"model", "application/vnd.ms-package.3dmanufacturing-3dmodel+xml"},
        {"png", "image/png"},
        {"jpg", "image/jpeg"},
        {"toml", "application/toml"},
        {"json", "application/json"},
        {"3mf", "model/3mf"},
        {"stl", "model/stl"},
        {"obj", "model/obj"},
    };
    for (const auto& [known, type] : kTypes)
        if (known == extension) return type;
    return "application/octet-stream";
}

std::string_view extension_of(std::string_view path) {
    const std::size_t dot = path.rfind('.');
    return dot == path.npos || path.find('/', dot) != path.npos ? std::string_view{} : path.substr(dot + 1);
}

}  // namespace fretwork
