#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/pipeline/carve.h"
#include "core/pipeline/region_schema.h"
#include "core/pipeline/setting_samples.h"
#include "core/pipeline/settings_schema.h"
#include "formats/read_file.h"
#include "formats/report_json.h"
#include "formats/spec_schema_json.h"
#include "formats/spec_template.h"
#include "formats/spec_toml_reader.h"
#include "formats/spec_toml_writer.h"

namespace fretwork {
namespace {

using Json = nlohmann::json;

bool same(const Settings& a, const Settings& b) {
    for (const SettingInfo& info : all_settings())
        if (info.get(a) != info.get(b)) {
            UNSCOPED_INFO(info.key);
            return false;
        }
    return write_spec_toml({{}, tables_from(a)}) == write_spec_toml({{}, tables_from(b)});
}

TEST_CASE("spec files: every key survives TOML", "[formats][spec]") {
    for (const SettingInfo& info : all_settings())
        for (const SettingValue& value : testing::good_values(info)) {
            CAPTURE(info.key, setting_text(value));
            const Settings settings = settings_from({{{info.key, value, ""}}, {}});
            const std::string text = write_spec_toml(document_from(settings));
            CHECK(same(settings_from(read_spec_toml(text, "test")), settings));
        }
}

TEST_CASE("spec files: the commented template is a spec for the same settings", "[formats][spec]") {
    const auto preset = GENERATE("draft", "default", "fine", "paper");
    Settings settings = settings_from({{{"synthesis.preset", std::string(preset), ""}}, {}});
    CHECK(same(settings_from(read_spec_toml(commented_spec(settings), "test")), settings));
    settings.shell.thickness_mm = 3.25;
    settings.synthesis.search.seed = 99;
    settings.keep.push_back({"rim", OpenBorderRegion{2.5}});
    settings.fixtures.push_back({{"base", LowestRegion{0.1}}, "drop"});
    const std::string text = commented_spec(settings);
    CHECK(same(settings_from(read_spec_toml(text, "test")), settings));
    for (const SettingInfo& info : all_settings()) {
        CAPTURE(info.key);
        CHECK(text.find(info.help) != std::string::npos);
        CHECK(text.find(describe_range(info)) != std::string::npos);
    }
}

TEST_CASE("spec files: the schema names every key with its range", "[formats][spec]") {
    const Json schema = Json::parse(spec_schema_json());
    for (const SettingInfo& info : all_settings()) {
        CAPTURE(info.key);
        const auto dot = info.key.find('.');
        const Json& key = schema["properties"][info.key.substr(0, dot)]["properties"][info.key.substr(dot + 1)];
        REQUIRE(key.is_object());
        CHECK(key["description"] == info.help);
        if (info.range) CHECK(key["maximum"] == info.range->max);
        if (!info.choices.empty()) CHECK(key["enum"].size() == info.choices.size());
    }
    for (const TableInfo& table : table_infos())
        CHECK(schema["properties"][table.array]["items"]["oneOf"].size() == region_shapes().size());
}

TEST_CASE("spec files: docs/spec.md holds the table of settings", "[formats][spec]") {
    const std::string page = read_file(std::filesystem::path(FRETWORK_REPOSITORY) / "docs/spec.md");
    // Made by: fretwork spec table
    CHECK(page.find(spec_markdown()) != std::string::npos);
}

// Whether every property of `value` is in the schema and every required one in the value, all the way down.
void check_against(const Json& schema, const Json& value, const std::string& path) {
    CAPTURE(path);
    if (value.is_object()) {
        const Json properties = schema.value("properties", Json::object());
        const bool open = schema.value("additionalProperties", Json(false)) != Json(false);
        for (const auto& [key, inner] : value.items()) {
            CAPTURE(key);
            if (!open) REQUIRE(properties.contains(key));
            if (properties.contains(key)) check_against(properties[key], inner, path + "." + key);
        }
        for (const Json& key : schema.value("required", Json::array())) {
            CAPTURE(key);
            CHECK(value.contains(key.get<std::string>()));
        }
    }
    if (value.is_array() && schema.contains("items"))
        for (const Json& item : value) check_against(schema["items"], item, path + "[]");
    if (!schema.contains("type")) return;
    const Json types = schema["type"].is_array() ? schema["type"] : Json::array({schema["type"]});
    bool fits = false;
    for (const Json& type : types) {
        const std::string name = type.get<std::string>();
        fits = fits || (name == "object" && value.is_object()) || (name == "array" && value.is_array()) ||
               (name == "string" && value.is_string()) || (name == "boolean" && value.is_boolean()) ||
               (name == "integer" && value.is_number_integer()) || (name == "number" && value.is_number()) ||
               (name == "null" && value.is_null());
    }
    CHECK(fits);
}

RunReport some_report() {
    RunReport report;
    report.version = version();
    report.input = {"model.stl", "cells", 1.0, {}};
    report.settings = document_from(Settings{}).assignments;
    report.seed = 7;
    report.iterations = {{}, {}};
    report.seconds = {{"synthesize", 1.5}, {"reinforce", 2.5}};
    report.seconds_total = 4.0;
    PrintabilityReport print;
    print.layers = 3;
    print.islands_per_layer = {0, 2, 0};
    print.islands = 2;
    print.island_places = {{Vec3(1, 2, 3), 0.5}};
    print.longest_bridge = {Vec3(4, 5, 6), 7.5};
    print.least_solid = PrintPlace{Vec3(7, 8, 9), 0.25};
    report.print = PrintRecord{print, {"a strand is 0.25 mm wide"}};
    StrengthRecord strength;
    strength.rounds = {{0.75, 12, 34}, {1.5, 3, 0}};
    strength.check.report.least_factor = 1.5;
    strength.check.report.safety_factor = 2.0;
    strength.check.report.cases.resize(1);
    strength.check.report.cases[0].name = "push";
    strength.check.report.weakest = {{Vec3(1, 2, 3), 1.5, 1e6, 2e6, 0}};
    strength.faults = {"is too weak"};
    strength.stopped_by = "no gain";
    report.strength = strength;
    report.slicing = SliceRecord{"prusa-slicer", "fdm.ini", "out.gcode", 12, 2.4, 60.0, {}, 3.5, {}, true, 0, {}, {}};
    report.warnings = {"one \"quoted\" \xFF byte"};
    return report;
}

TEST_CASE("report: fits its published schema", "[formats][report]") {
    const Json schema = Json::parse(read_file(std::filesystem::path(FRETWORK_REPOSITORY) / "docs/report.schema.json"));
    const Json report = Json::parse(report_json(some_report()));
    check_against(schema, report, "report");
    // The fields that DESIGN promises.
    for (const char* key : {"version", "input", "settings", "seed", "shell", "pattern", "iterations", "structure",
                            "mesh", "printability", "seconds", "peak_memory_bytes", "warnings"})
        CHECK(report.contains(key));
    CHECK(report["seconds"]["initial_synthesis"] == 1.5);
    CHECK(report["seconds"]["total"] == 4.0);
    CHECK(report["iterations"].size() == 2);
    CHECK(report["strength"]["factor_of_safety"] == 1.5);
    CHECK(report["strength"]["rounds"][0] ==
          Json({{"factor_of_safety", 0.75}, {"weak_voxels", 12}, {"voxels_added", 34}}));
    CHECK(report["strength"]["weakest"][0]["case"] == "push");
    const Json& print = report["printability"];
    CHECK(print["island_layers"] == Json::array({{{"layer", 1}, {"islands", 2}}}));
    CHECK(print["longest_bridge_at_mm"] == Json({4.0, 5.0, 6.0}));
    CHECK(print["least_solid_mm"] == 0.25);
    CHECK_FALSE(print.contains("least_hole_mm"));
    CHECK_FALSE(print.contains("longest_cantilever_at_mm"));
    CHECK(print["faults"].size() == 1);
}

TEST_CASE("report: of several objects fits the schema too", "[formats][report]") {
    const Json schema = Json::parse(read_file(std::filesystem::path(FRETWORK_REPOSITORY) / "docs/report.schema.json"));
    RunReport first = some_report(), second = some_report();
    second.seed = 8;
    first.paint = {PaintFormat::kBambu, {{1, 2, 3}, {255, 0, 16}}};
    const std::vector<ObjectReport> objects = {{"lid", "L-1", "3D/3dmodel.model", 4, 2, first},
                                               {"box", "", "3D/3dmodel.model", 5, 1, second}};
    const Json report = Json::parse(report_json(objects));
    check_against(schema, report, "report");
    CHECK(report["seed"] == 7);
    CHECK(report["objects"][1]["report"]["seed"] == 8);
    CHECK(report["objects"][0]["id"] == 4);
    CHECK(report["paint"]["extruders"][1] == "#FF0010");
    for (const Json& object : report["objects"]) check_against(schema, object["report"], "object");
}

TEST_CASE("report: without times it is the same on every run", "[formats][report]") {
    RunReport quick = some_report(), slow = some_report();
    slow.seconds[0].seconds = 99.0;
    slow.seconds_total = 100.0;
    slow.peak_memory_bytes = 1 << 30;
    CHECK(report_json(quick) != report_json(slow));
    CHECK(report_json(quick, ReportTimes::kLeaveOut) == report_json(slow, ReportTimes::kLeaveOut));
}

}  // namespace
}  // namespace fretwork
