#include "cli/scad_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/pipeline/region_schema.h"
#include "formats/mesh_file.h"

namespace fretwork::cli {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kEcho = "ECHO: fretwork = ";

/// As the user has written it.
std::string call_of(const ScadMark& mark) {
    const std::string module = mark.kind == "loads" ? "load" : mark.kind == "fixtures" ? "fixture" : mark.kind;
    return fmt::format("fretwork_{}(\"{}\")", module, mark.name);
}

/// Lists that another program of the user echoes under this name are not ours to judge.
std::optional<ScadMark> mark_in(const std::string& line) {
    if (!line.starts_with(kEcho)) return std::nullopt;
    Json list = Json::parse(line.substr(kEcho.size()), nullptr, false);
    if (!list.is_array() || list.size() < 2 || !list[0].is_string() || !list[1].is_string()) return std::nullopt;
    ScadMark mark{list[0], list[1], {}};
    list.erase(list.begin(), list.begin() + 2);
    mark.values = list.dump();
    return mark;
}

/// The tables of settings that hold just this mark.
std::vector<SettingTable> tables_of(const ScadMark& mark, TriangleMesh surface) {
    const Region region{mark.name, VolumeRegion{std::move(surface)}};
    const Json values = Json::parse(mark.values);
    Settings settings;
    if (mark.kind == "keep")
        settings.keep.push_back(region);
    else if (mark.kind == "carve")
        settings.carve.push_back(region);
    else if (mark.kind == "fixtures")
        settings.fixtures.push_back({region, values.at(0).get<std::string>()});
    else
        settings.loads.push_back({region, values.at(4).get<std::string>(),
                                  Vec3(values.at(0), values.at(1), values.at(2)), values.at(3).get<double>()});
    return tables_from(settings);
}

}  // namespace

std::vector<ScadMark> marks_in(const std::vector<std::string>& lines, const std::string& path) {
    std::vector<ScadMark> marks;
    for (const std::string& line : lines) {
        const std::optional<ScadMark> mark = mark_in(line);
        if (!mark) continue;
        const auto same = std::ranges::find_if(
            marks, [&](const ScadMark& other) { return other.kind == mark->kind && other.name == mark->name; });
        if (same == marks.end())
            marks.push_back(*mark);
        else if (*same != *mark)
            throw InvalidSetting(fmt::format("{}: {} says {} and {}; give one of them another name", path,
                                             call_of(*mark), same->values, mark->values));
    }
    return marks;
}

std::vector<SettingTable> render_marks(const OpenScad& scad, const std::vector<ScadMark>& marks,
                                       std::set<std::string>& files, const RunControl& run) {
    if (marks.empty()) return {};
    if (!scad.render("none", run).draws_nothing())
        throw InvalidInput(
            fmt::format("{}: draws something outside of fretwork_body(); a part with marks stands in it", scad.name()));
    std::vector<SettingTable> tables;
    for (const ScadMark& mark : marks) {
        ScadRender render = scad.render(mark.kind + ":" + mark.name, run);
        const std::string source = fmt::format("{}: {}", scad.name(), call_of(mark));
        if (!render.error.empty()) throw InvalidInput(fmt::format("{}: OpenSCAD: {}", source, render.error));
        files.merge(render.files);
        for (SettingTable& table : tables_of(mark, read_mesh(render.off, MeshFormat::kOff, source).mesh)) {
            table.place = source;
            tables.push_back(std::move(table));
        }
    }
    return tables;
}

}  // namespace fretwork::cli
