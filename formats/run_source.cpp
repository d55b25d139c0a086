#include "formats/run_source.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "formats/content_hash.h"
#include "formats/opc_edit.h"
#include "formats/parse_error.h"
#include "formats/threemf_names.h"
#include "formats/threemf_package.h"

namespace fretwork {
namespace {

using Json = nlohmann::ordered_json;
using threemf::without_slash;

constexpr std::uint64_t kMaxTextBytes = 8 << 20;
constexpr std::uint64_t kMaxSourceBytes = std::uint64_t{4} << 30;
const std::string kFolder = "/Metadata/fretwork/";

Json file_json(const RunFile& file, const std::string& part) {
    Json json = {{"path", file.path}, {"sha256", file.sha256}};
    if (!file.bytes.empty()) json["part"] = part;
    return json;
}

class SourceReader {
  public:
    SourceReader(std::string_view package, std::string_view name) : name_(name), zip_(package, name) {
        const std::string root(threemf::kRootRelationsPart);
        if (zip_.contains(root)) relations_ = zip_.read(root, kMaxTextBytes);
    }

    [[nodiscard]] bool names(std::string_view relation) const {
        return !target_of_relation(relations_, relation).empty();
    }

    [[nodiscard]] std::string text_at(std::string_view relation) const {
        const std::string target = target_of_relation(relations_, relation);
        if (target.empty())
            throw InvalidInput(name_ + ": found no record of a run, expected a 3MF that was carved by Fretwork");
        return zip_.read(without_slash(target), kMaxTextBytes);
    }

    RunSource read() const {
        RunSource source;
        source.request_toml = text_at(threemf::kRequestRelation);
        try {
            const Json json = Json::parse(text_at(threemf::kRunRelation));
            source.version = json.at("version");
            source.model_format = json.at("model").at("format");
            source.model_unit = json.at("model").at("unit");
            source.model = file_of(json.at("model"));
            if (json.contains("materials"))
                for (const Json& file : json.at("materials")) source.materials.push_back(file_of(file));
            for (const Json& picture : json.at("pictures")) source.pictures.push_back(file_of(picture));
        } catch (const Json::exception& error) {
            fail_parse(name_, "run.json", in_quotes(error.what()), "the record of a run");
        }
        return source;
    }

  private:
    [[nodiscard]] RunFile file_of(const Json& json) const {
        RunFile file;
        file.path = json.at("path");
        file.sha256 = json.at("sha256");
        if (!json.contains("part")) return file;
        const std::string part = json.at("part");
        file.bytes = zip_.read(without_slash(part), kMaxSourceBytes);
        if (content_hash(file.bytes) != file.sha256)
            fail_parse(name_, part, "other bytes than were carved", "those with SHA-256 " + file.sha256);
        return file;
    }

    std::string name_;
    ZipReader zip_;
    std::string relations_;
};

}  // namespace

RunFile run_file(std::string path, std::string_view bytes, bool keep) {
    return {std::move(path), content_hash(bytes), keep ? std::string(bytes) : std::string{}};
}

std::vector<RecordPart> parts_of(const RunSource& source) {
    std::vector<RecordPart> files;
    const auto add_file = [&](const RunFile& file, const std::string& part, std::string_view relation) {
        if (!file.bytes.empty()) files.push_back({part, relation, file.bytes});
        return file_json(file, part);
    };
    Json json = {{"version", source.version}};
    json["model"] = add_file(source.model, kFolder + "source." + source.model_format, threemf::kSourceRelation);
    json["model"]["format"] = source.model_format;
    json["model"]["unit"] = source.model_unit;
    for (std::size_t i = 0; i < source.materials.size(); ++i)
        json["materials"].push_back(add_file(
            source.materials[i], kFolder + "materials" + std::to_string(i + 1) + ".mtl", threemf::kMaterialsRelation));
    json["pictures"] = Json::array();
    for (std::size_t i = 0; i < source.pictures.size(); ++i) {
        const RunFile& picture = source.pictures[i];
        const bool png = picture.bytes.starts_with("\x89PNG");
        const std::string part = kFolder + "picture" + std::to_string(i + 1) + (png ? ".png" : ".jpg");
        json["pictures"].push_back(add_file(picture, part, threemf::kPictureRelation));
    }
    std::vector<RecordPart> parts = {
        {kFolder + "run.json", threemf::kRunRelation, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"},
        {kFolder + "request.toml", threemf::kRequestRelation, source.request_toml}};
    parts.insert(parts.end(), files.begin(), files.end());
    return parts;
}

bool has_run_source(std::string_view package, std::string_view name) {
    return SourceReader(package, name).names(threemf::kRunRelation);
}

std::string read_run_report(std::string_view package, std::string_view name) {
    const SourceReader reader(package, name);
    return reader.names(threemf::kReportRelation) ? reader.text_at(threemf::kReportRelation) : std::string{};
}

RunSource read_run_source(std::string_view package, std::string_view name) {
    return SourceReader(package, name).read();
}

}  // namespace fretwork
