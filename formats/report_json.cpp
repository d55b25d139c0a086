#include "formats/report_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/color_channel.h"
#include "formats/printability_facts.h"
#include "formats/strength_facts.h"

namespace fretwork {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity; a number that is not finite is told as null.
Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json vec_json(const Vec3& v) {
    return Json::array({number(v[0]), number(v[1]), number(v[2])});
}

Json value_json(const SettingValue& value) {
    return std::visit([](const auto& held) { return Json(held); }, value);
}

Json mesh_json(const MeshReport& m) {
    Json json = {{"vertices", m.vertices},
                 {"triangles", m.triangles},
                 {"min_mm", vec_json(m.min_mm)},
                 {"max_mm", vec_json(m.max_mm)},
                 {"area_mm2", number(m.area_mm2)},
                 {"volume_mm3", number(m.volume_mm3)},
                 {"components", m.components},
                 {"closed", m.border_edges == 0 && m.triangles > 0},
                 {"manifold", m.closed_manifold() && m.non_manifold_vertices == 0},
                 {"border_edges", m.border_edges},
                 {"non_manifold_edges", m.non_manifold_edges},
                 {"non_manifold_vertices", m.non_manifold_vertices},
                 {"flipped_edges", m.flipped_edges},
                 {"degenerate_triangles", m.degenerate_triangles},
                 {"duplicate_triangles", m.duplicate_triangles}};
    json["self_intersections"] = m.self_intersections_counted ? Json(m.self_intersections) : Json(nullptr);
    return json;
}

Json settings_json(const std::vector<SettingAssignment>& assignments, const std::vector<SettingTable>& tables) {
    Json json = Json::object();
    for (const SettingAssignment& a : assignments) {
        const auto dot = a.key.find('.');
        json[a.key.substr(0, dot)][a.key.substr(dot + 1)] = value_json(a.value);
    }
    for (const SettingTable& table : tables) {
        Json entry = Json::object();
        for (const SettingAssignment& a : table.entries) entry[a.key] = value_json(a.value);
        // "carve" and the like never clash with a section: sections hold keys, arrays hold tables.
        json[table.array].push_back(entry);
    }
    return json;
}

Json pattern_json(const PatternRecord& p) {
    return {{"exemplar_width_mm", number(p.exemplar_width_mm)},
            {"pixels_per_voxel", number(p.pixels_per_voxel)},
            {"exemplar_solid_fraction", number(p.exemplar_solid_fraction)},
            {"solid_voxels", p.solid_voxels},
            {"solid_fraction", number(p.solid_fraction)},
            {"reinforced_voxels", p.reinforced_voxels},
            {"kept_voxels", p.kept_voxels},
            {"components_before", p.components_before},
            {"components_after", p.components_after},
            {"voxels_enlarged", p.voxels_enlarged},
            {"voxels_filled", p.voxels_filled},
            {"islands_dropped", p.islands_dropped},
            {"islands_joined", p.islands_joined}};
}

Json iteration_json(const ReinforceRecord& r) {
    return {
        {"iteration", r.iteration},
        {"components", r.components_before},
        {"specks_dropped", r.specks_dropped},
        {"bridges", {{"connect", r.bridges_connect}, {"stress", r.bridges_stress}, {"geodesic", r.bridges_geodesic}}},
        {"voxels_added", r.voxels_added},
        {"max_score_pa", number(r.max_score_pa)},
        {"p99_score_pa", number(r.p99_score_pa)},
        {"median_score_pa", number(r.median_score_pa)},
        {"average_score_pa", number(r.average_score_pa)},
        {"max_geodesic", number(r.max_geodesic)},
        {"connected", r.connected},
        {"stopped_by", r.stopped_by}};
}

Json structure_json(const StructureRecord& s) {
    return {{"max_pa", number(s.max_pa)}, {"average_pa", number(s.average_pa)},     {"median_pa", number(s.median_pa)},
            {"p99_pa", number(s.p99_pa)}, {"allowable_pa", number(s.allowable_pa)}, {"verdict", s.verdict},
            {"stopped_by", s.stopped_by}};
}

Json strength_json(const StrengthRecord& s) {
    Facts facts;
    add_strength_facts(s.check, s.faults, "", facts);
    Json json = Json::parse(facts_json(facts));
    json["rounds"] = Json::array();
    for (const StrengthRound& round : s.rounds)
        json["rounds"].push_back({{"factor_of_safety", number(round.least_factor)},
                                  {"weak_voxels", round.weak_voxels},
                                  {"voxels_added", round.voxels_added}});
    json["stopped_by"] = s.stopped_by;
    return json;
}

Json printability_json(const RunReport& r) {
    const MeshReport& mesh = r.mesh.report;
    Json json = {
        {"min_feature_mm", number(r.mesh.min_feature_mm)},
        {"min_hole_mm", number(r.mesh.min_hole_mm)},
        {"one_piece", r.pattern.components_after == r.shell.components},
        {"valid_mesh", mesh.closed_manifold() && mesh.non_manifold_vertices == 0 && mesh.self_intersections == 0},
        {"islands_removed", r.mesh.islands_removed},
        {"islands_volume_mm3", number(r.mesh.islands_volume_mm3)}};
    if (!r.print) return json;
    Facts facts;
    add_printability_facts(r.print->report, r.print->faults, "", facts);
    json.update(Json::parse(facts_json(facts)));
    return json;
}

Json seconds_json(const RunReport& r) {
    Json json = Json::object();
    for (const StageSeconds& stage : r.seconds) {
        json[stage.stage] = number(stage.seconds);
        if (stage.stage == "synthesize") json["initial_synthesis"] = number(stage.seconds);
        if (stage.stage == "reinforce") json["resynthesis"] = number(r.seconds_resynthesis);
    }
    json["total"] = number(r.seconds_total);
    return json;
}

Json paint_json(const PaintRecord& paint) {
    Json colors = Json::array();
    for (const Rgb8& color : paint.extruders) colors.push_back(hex_color(color));
    return {{"slicer", paint.format == PaintFormat::kPrusa ? "prusa" : "bambu"}, {"extruders", colors}};
}

Json or_null(const std::optional<double>& value) {
    return value ? number(*value) : Json(nullptr);
}

Json slicing_json(const SliceRecord& s) {
    return {{"slicer", s.slicer},
            {"profile", s.profile},
            {"output", s.output},
            {"layers", s.layers},
            {"height_mm", number(s.height_mm)},
            {"seconds", or_null(s.seconds)},
            {"filament_mm", or_null(s.filament_mm)},
            {"filament_g", or_null(s.filament_g)},
            {"material_ml", or_null(s.material_ml)},
            {"parts_compared", s.parts_compared},
            {"lost_parts", s.lost_parts},
            {"warnings", s.warnings},
            {"faults", s.faults}};
}

Json whole_json(const RunReport& r, ReportTimes times) {
    Json json;
    json["version"] = r.version;
    json["input"] = {{"model", r.input.model},
                     {"exemplar", r.input.exemplar},
                     {"scale", number(r.input.scale)},
                     {"mesh", mesh_json(r.input.mesh)}};
    json["settings"] = settings_json(r.settings, r.regions);
    json["seed"] = r.seed;
    json["shell"] = {{"resolution", r.shell.resolution},
                     {"voxel_mm", number(r.shell.voxel_mm)},
                     {"surface_voxels", r.shell.surface_voxels},
                     {"components", r.shell.components},
                     {"thickness_mm", number(r.shell.thickness_mm)}};
    json["pattern"] = pattern_json(r.pattern);
    json["iterations"] = Json::array();
    for (const ReinforceRecord& record : r.iterations) json["iterations"].push_back(iteration_json(record));
    json["structure"] = structure_json(r.structure);
    if (r.strength) json["strength"] = strength_json(*r.strength);
    json["mesh"] = mesh_json(r.mesh.report);
    json["mesh"]["min_feature_mm"] = number(r.mesh.min_feature_mm);
    json["printability"] = printability_json(r);
    if (times == ReportTimes::kInclude) {
        json["seconds"] = seconds_json(r);
        json["peak_memory_bytes"] = r.peak_memory_bytes;
    }
    if (r.paint.format != PaintFormat::kNone) json["paint"] = paint_json(r.paint);
    if (r.slicing) json["slicing"] = slicing_json(*r.slicing);
    json["warnings"] = r.warnings;
    return json;
}

std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string report_json(const RunReport& report, ReportTimes times) {
    return text_of(whole_json(report, times));
}

std::string report_json(std::span<const ObjectReport> objects, ReportTimes times) {
    Json json = whole_json(objects.front().report, times);
    json["objects"] = Json::array();
    for (const ObjectReport& object : objects)
        json["objects"].push_back({{"name", object.name},
                                   {"part_number", object.part_number},
                                   {"part", object.part},
                                   {"id", object.id},
                                   {"instances", object.instances},
                                   {"report", whole_json(object.report, times)}});
    return text_of(json);
}

}  // namespace fretwork
