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

std::string model_bytes(RunFile& model, const std::string& package, const std::string& source) {
    if (source.empty() && !model.bytes.empty()) return std::move(model.bytes);
    if (source.empty())
        throw InvalidSetting(fmt::format("{}: the model is not in it: name it with --source (it was {}, SHA-256 {})",
                                         package, model.path, model.sha256));
    std::string bytes = read_file(std::filesystem::path(source));
    if (const std::string found = run_file(source, bytes, false).sha256; found != model.sha256)
        throw InvalidInput(
            fmt::format("{}: found SHA-256 {}, expected the model that was carved, {}", source, found, model.sha256));
    return bytes;
}

}  // namespace

CarveRequest request_of_package(const ModelBytes& package, const std::string& source, const PatternOptions& pattern) {
    if (names_spec(pattern.pattern))
        throw InvalidSetting(fmt::format("--again and --pattern {} both bring a spec; leave one out", pattern.pattern));
    RunSource run = read_run_source(package.bytes, package.name);
    CarveRequest request;
    request.model.format = mesh_format_from_name(run.model_format);
    request.model.unit = unit_named(run.model_unit);
    request.model.name = run.model.path;
    request.model.bytes = model_bytes(run.model, package.name, source);
    request.pictures = PictureFiles(std::move(run.pictures));
    request.settings = settings_of(pattern, read_spec_toml(run.request_toml, package.name + ": request.toml"));
    if (run.version != version())
        request.warnings.push_back(fmt::format("{} was carved by version {}, this is {}: the result may differ",
                                               package.name, run.version, version()));
    return request;
}

}  // namespace fretwork::cli
