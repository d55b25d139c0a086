#include "cli/carve_again.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/pipeline/carve.h"
#include "formats/read_file.h"
#include "formats/run_source.h"
#include "formats/spec_toml_reader.h"

namespace fretwork::cli {
namespace {

/// A file that has to be the one that was read then.
std::string same_file(const std::string& path, const RunFile& then, std::string_view what) {
    std::string bytes = read_file(std::filesystem::path(path));
    if (const std::string found = run_file(path, bytes, false).sha256; found != then.sha256)
        throw InvalidInput(fmt::format("{}: found SHA-256 {}, expected {}, {}", path, found, what, then.sha256));
    return bytes;
}

/// Materials of an OBJ that the package only names lie beside the model that `source` names.
void read_materials(const std::string& source, CarveRequest& request) {
    for (RunFile& file : request.model.materials) {
        if (!file.bytes.empty() || source.empty()) continue;
        const std::string path = (std::filesystem::path(source).parent_path() / file.path).string();
        file.bytes = same_file(path, file, "the materials that were read");
        request.sources.push_back(path);
    }
}

std::string model_bytes(RunFile& model, const std::string& package, const std::string& source) {
    if (source.empty() && !model.bytes.empty()) return std::move(model.bytes);
    if (source.empty())
        throw InvalidSetting(fmt::format("{}: the model is not in it: name it with --source (it was {}, SHA-256 {})",
                                         package, model.path, model.sha256));
    return same_file(source, model, "the model that was carved");
}

}  // namespace

CarveRequest request_of_package(const ModelBytes& package, const std::string& source, const PatternOptions& pattern) {
    if (names_spec(pattern.pattern))
        throw InvalidSetting(fmt::format("--again and --pattern {} both bring a spec; leave one out", pattern.pattern));
    return request_of_run(read_run_source(package.bytes, package.name), package.name, source, pattern);
}

CarveRequest request_of_run(RunSource run, const std::string& package, const std::string& source,
                            const PatternOptions& pattern) {
    CarveRequest request;
    request.model.format = mesh_format_from_name(run.model_format);
    request.model.unit = unit_named(run.model_unit);
    request.model.name = run.model.path;
    request.model.bytes = model_bytes(run.model, package, source);
    request.model.materials = std::move(run.materials);
    if (!source.empty()) request.sources.push_back(source);
    read_materials(source, request);
    request.pictures = PictureFiles(std::move(run.pictures));
    request.settings = settings_of(pattern, read_spec_toml(run.request_toml, package + ": request.toml"));
    if (run.version != version())
        request.warnings.push_back(fmt::format("{} was carved by version {}, this is {}: the result may differ",
                                               package, run.version, version()));
    return request;
}

}  // namespace fretwork::cli
