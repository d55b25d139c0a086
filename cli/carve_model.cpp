#include "cli/carve_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/base/error.h"
#include "core/base/words.h"

namespace fretwork::cli {
namespace {

std::string described(const ThreemfObject& object) {
    std::string text = object.name.empty() ? fmt::format("object {}", object.key.id)
                                           : fmt::format("\"{}\" (id {}", object.name, object.key.id);
    if (!object.part_number.empty())
        text += fmt::format("{}part number {}", object.name.empty() ? " (" : ", ", object.part_number);
    return object.name.empty() && object.part_number.empty() ? text : text + ")";
}

std::string listed(const std::vector<ThreemfObject>& objects) {
    constexpr std::size_t most = 20;
    std::vector<std::string> names;
    for (const ThreemfObject& object : objects) names.push_back(described(object));
    if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
    return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + most, ", "), names.size() - most);
}

bool is_called(const ThreemfObject& object, const std::string& word) {
    const auto is_id = [&](const threemf::ObjectKey& key) { return std::to_string(key.id) == word; };
    return object.name == word || object.part_number == word || is_id(object.key) ||
           std::ranges::find(object.parent_names, word) != object.parent_names.end() ||
           std::ranges::any_of(object.parents, is_id);
}

/// The objects to carve, in the order of the file.
std::vector<bool> chosen(const std::vector<ThreemfObject>& objects, const std::string& asked, const std::string& file) {
    std::vector<bool> take(objects.size(), false);
    const auto take_called = [&](const std::string& word) {
        bool found = false;
        for (std::size_t i = 0; i < objects.size(); ++i)
            if (is_called(objects[i], word)) take[i] = found = true;
        return found;
    };
    if (asked.empty()) {
        for (std::size_t i = 0; i < objects.size(); ++i) take[i] = objects[i].printable && objects[i].type == "model";
        if (std::ranges::count(take, true) == 0)
            throw InvalidInput(
                fmt::format("{}: found no object that is printed, expected one; there are {}; "
                            "--objects carves what it names",
                            file, listed(objects)));
        return take;
    }
    // A name may hold a comma itself.
    if (take_called(asked)) return take;
    for (const std::string& word : words_between_commas(asked))
        if (!take_called(word))
            throw InvalidSetting(
                fmt::format("--objects: found no \"{}\" in {}, expected one of {}", word, file, listed(objects)));
    return take;
}

CarveTarget target_of(ThreemfObject object) {
    CarveTarget target;
    target.key = std::move(object.key);
    target.name = std::move(object.name);
    target.part_number = std::move(object.part_number);
    target.instances = object.instances;
    target.least_scale = object.least_scale;
    target.most_scale = object.most_scale;
    target.mesh = std::move(object.mesh);
    target.triangle_colors = std::move(object.triangle_colors);
    return target;
}

void open_threemf(const Settings& settings, CarveModel& model, const RunControl& run) {
    const ThreemfReadOptions options{settings.input.ignore_required};
    ThreemfObjects found = read_threemf_objects(model.file.bytes, model.file.name, options, run);
    model.warnings = std::move(found.warnings);
    if (found.objects.empty()) throw InvalidInput(model.file.name + ": found no object with triangles, expected one");
    const std::vector<bool> take = chosen(found.objects, settings.input.objects, model.file.name);
    for (std::size_t i = 0; i < take.size(); ++i)
        if (take[i]) model.targets.push_back(target_of(std::move(found.objects[i])));
}

std::vector<NamedTriangles> named_triangles_of(const MeshFile& file) {
    std::vector<NamedTriangles> named;
    for (const auto* list : {&file.faces, &file.parts})
        for (const MeshPart& part : *list)
            if (!part.name.empty()) named.push_back({part.name, part.first_triangle, part.triangle_count});
    return named;
}

void open_mesh(const Settings& settings, CarveModel& model, const RunControl& run) {
    if (!settings.input.objects.empty())
        throw InvalidSetting(
            fmt::format("--objects {}: found {}, expected a 3MF", settings.input.objects, model.file.name));
    const ModelBytes& file = model.file;
    MeshFile read = read_model(file, meshing_for(settings), run);
    CarveTarget& target = model.targets.emplace_back();
    target.name = title_of(file);
    target.mesh = std::move(read.mesh);
    target.named_triangles = named_triangles_of(read);
    target.triangle_colors = std::move(read.triangle_colors);
    model.materials = file.materials;
    for (FileBeside& beside : read.read_beside) {
        model.read_beside.push_back(beside.path.string());
        if (file.format == MeshFormat::kObj)
            model.materials.push_back(run_file(beside.path.filename().string(), beside.bytes, true));
    }
    model.warnings = std::move(read.warnings);
}

void warn_of_unmatched(const Settings& settings, CarveModel& model) {
    for (const ObjectOption& option : settings.objects) {
        const bool used = std::ranges::any_of(model.targets, [&](const CarveTarget& target) {
            const std::vector<std::string> names = target.names();
            return std::ranges::find(names, option.match) != names.end();
        });
        if (!used)
            model.warnings.push_back(
                fmt::format("[[object]] match = \"{}\": no carved object is called that", option.match));
    }
}

}  // namespace

std::vector<std::string> CarveTarget::names() const {
    std::vector<std::string> all;
    if (!name.empty()) all.push_back(name);
    if (key) all.push_back(std::to_string(key->id));
    if (!part_number.empty()) all.push_back(part_number);
    return all;
}

CarveModel open_model(ModelBytes file, const Settings& settings, const RunControl& run) {
    CarveModel model;
    model.file = std::move(file);
    if (model.file.format == MeshFormat::kThreemf)
        open_threemf(settings, model, run);
    else
        open_mesh(settings, model, run);
    warn_of_unmatched(settings, model);
    return model;
}

}  // namespace fretwork::cli
