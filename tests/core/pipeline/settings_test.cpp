#include <catch2/catch.hpp>
#include <set>

#include "core/base/error.h"
#include "core/pipeline/object_settings.h"
#include "core/pipeline/region_schema.h"
#include "core/pipeline/setting_samples.h"
#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

using testing::bad_values;
using testing::good_values;

TEST_CASE("settings: every key says what it is", "[pipeline]") {
    std::set<std::string> keys;
    for (const SettingInfo& info : all_settings()) {
        CAPTURE(info.key);
        CHECK(keys.insert(info.key).second);
        CHECK(info.key.find('.') != std::string::npos);
        CHECK(info.help.size() > 8);
        CHECK(info.help.ends_with('.'));
        CHECK_FALSE(info.unit.empty());
        const bool numeric = info.type == SettingType::kInteger || info.type == SettingType::kNumber;
        CHECK(info.range.has_value() == numeric);
        CHECK(info.choices.empty() == (info.type != SettingType::kChoice));
        // A key without a value tells where it then comes from, and the other way round.
        CHECK(info.get(Settings{}).has_value() == info.when_unset.empty());
    }
}

TEST_CASE("settings: every key gives back what it was given", "[pipeline]") {
    for (const SettingInfo& info : all_settings())
        for (const SettingValue& value : good_values(info)) {
            CAPTURE(info.key, setting_text(value));
            Settings settings;
            apply_setting(settings, {info.key, value, "test"});
            REQUIRE(info.get(settings).has_value());
            CHECK(*info.get(settings) == value);
            // Nothing else has changed.
            for (const SettingInfo& other : all_settings())
                if (other.key != info.key) REQUIRE(other.get(settings) == other.get(Settings{}));
        }
}

TEST_CASE("settings: values out of range are refused with key, value and range", "[pipeline]") {
    for (const SettingInfo& info : all_settings())
        for (const SettingValue& value : bad_values(info)) {
            CAPTURE(info.key, setting_text(value));
            Settings settings;
            std::string message;
            try {
                apply_setting(settings, {info.key, value, "spec.toml: line 7"});
            } catch (const InvalidSetting& error) {
                message = error.what();
            }
            CHECK(message.starts_with("spec.toml: line 7: " + info.key + " = "));
            CHECK(message.find(describe_range(info)) != std::string::npos);
            CHECK(info.get(settings) == info.get(Settings{}));
        }
}

TEST_CASE("settings: text from a flag is read as the key wants it", "[pipeline]") {
    for (const SettingInfo& info : all_settings())
        for (const SettingValue& value : good_values(info)) {
            const auto* text = std::get_if<std::string>(&value);
            const std::string typed = text ? *text : setting_text(value);
            CAPTURE(info.key, typed);
            CHECK(parse_assignment(info.key + "=" + typed, "-D").value == value);
        }
    CHECK(std::get<double>(parse_assignment("shell.thickness_mm = 3", "-D").value) == 3.0);
    CHECK(parse_assignment("synthesis.orientation=1,0,0", "-D").value == SettingValue(std::vector<double>{1, 0, 0}));
    CHECK_THROWS_AS(parse_assignment("shell.thickness_mm", "-D"), InvalidSetting);
    CHECK_THROWS_AS(parse_assignment("shell.thickness_mm=", "-D"), InvalidSetting);
    CHECK_THROWS_AS(parse_assignment("shell.thickness_mm=2mm", "-D"), InvalidSetting);
    CHECK_THROWS_AS(parse_assignment("shell.resolution=12.5", "-D"), InvalidSetting);
}

TEST_CASE("settings: an unknown key is answered with the nearest one", "[pipeline]") {
    const auto suggestion = [](const char* key) {
        try {
            setting_info(key, "-D");
        } catch (const InvalidSetting& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(suggestion("shell.thicknes_mm").find("'shell.thickness_mm'") != std::string::npos);
    CHECK(suggestion("resolution").find("'shell.resolution'") != std::string::npos);
    CHECK(suggestion("fabrication.min_holes_mm").find("'fabrication.min_hole_mm'") != std::string::npos);
}

TEST_CASE("settings: keys win over the preset, wherever it stands", "[pipeline]") {
    const SettingAssignment preset{"synthesis.preset", std::string("paper"), ""};
    const SettingAssignment key{"synthesis.candidates", std::int64_t{7}, ""};
    for (const auto& order : {std::vector{preset, key}, std::vector{key, preset}}) {
        const Settings settings = settings_from({order, {}});
        CHECK(settings.synthesis.search.candidates == 7);
        CHECK(settings.synthesis.search.directions == 26);
        CHECK(settings.structure.steps.rules == ReinforceRules::kPaper);
    }
}

TEST_CASE("settings: a document gives the same settings again", "[pipeline]") {
    const auto preset = GENERATE(Preset::kDraft, Preset::kDefault, Preset::kFine, Preset::kPaper);
    Settings settings;
    apply_preset(settings, preset);
    settings.shell.thickness_mm = 1.0 / 3.0;
    settings.keep.push_back({"lid", CylinderRegion{Vec3(0, 0, 1), Vec3(0, 0, 2), 3.5}});
    settings.loads.push_back({{"push", LowestRegion{0.25}}, "case a", Vec3(1, 2, 3), 0.5});
    const SpecDocument document = document_from(settings);
    const SpecDocument again = document_from(settings_from(document));
    REQUIRE(again.assignments.size() == document.assignments.size());
    for (std::size_t i = 0; i < document.assignments.size(); ++i) {
        CHECK(again.assignments[i].key == document.assignments[i].key);
        CHECK(again.assignments[i].value == document.assignments[i].value);
    }
    CHECK(again.tables.size() == 2);
}

SettingTable table_of(const char* array, const char* shape) {
    for (const RegionShapeInfo& info : region_shapes()) {
        if (info.shape != shape) continue;
        SettingTable table{
            array, {{"shape", info.shape, ""}, {"name", std::string("the ") + shape, ""}}, "spec.toml: line 3"};
        double next = 0.125;
        for (const RegionKeyInfo& key : info.keys) {
            std::vector<double> numbers;
            for (int i = 0; i < std::max(key.numbers, 1); ++i) numbers.push_back(next *= 2.0);
            if (info.shape == "triangles") numbers = {0, 5, 9};
            if (key.key == "vertices") numbers = {0, 0, 0, 1.5, 0, 0, 0, 2.5, 0};
            if (key.key == "corners") numbers = {2, 0, 1};
            if (key.numbers == 1)
                table.entries.push_back({key.key, numbers[0], ""});
            else
                table.entries.push_back({key.key, numbers, ""});
        }
        for (const RegionKeyInfo& key : info.texts) table.entries.push_back({key.key, std::string("Face1, a lid"), ""});
        return table;
    }
    return {};
}

TEST_CASE("settings: every shape of region goes in and comes out", "[pipeline]") {
    for (const RegionShapeInfo& shape : region_shapes()) {
        CAPTURE(shape.shape);
        const SettingTable table = table_of("keep", shape.shape.c_str());
        Settings settings;
        apply_table(settings, table);
        REQUIRE(settings.keep.size() == 1);
        CHECK(settings.keep[0].name == "the " + shape.shape);
        const std::vector<SettingTable> tables = tables_from(settings);
        REQUIRE(tables.size() == 1);
        for (const SettingAssignment& entry : table.entries) {
            const auto same_key = [&](const SettingAssignment& other) { return other.key == entry.key; };
            const auto found = std::find_if(tables[0].entries.begin(), tables[0].entries.end(), same_key);
            REQUIRE(found != tables[0].entries.end());
            CHECK(found->value == entry.value);
        }
        // Each of its keys is needed.
        for (std::size_t i = 2; i < table.entries.size(); ++i) {
            SettingTable lacking = table;
            lacking.entries.erase(lacking.entries.begin() + static_cast<std::ptrdiff_t>(i));
            Settings untouched;
            CHECK_THROWS_AS(apply_table(untouched, lacking), InvalidSetting);
        }
    }
}

TEST_CASE("settings: regions with mistakes are refused by place", "[pipeline]") {
    const auto refused = [](SettingTable table, const char* expected) {
        table.place = "spec.toml: line 3";
        Settings settings;
        try {
            apply_table(settings, table);
        } catch (const InvalidSetting& error) {
            CAPTURE(error.what());
            CHECK(std::string(error.what()).starts_with("spec.toml: line 3"));
            CHECK(std::string(error.what()).find(expected) != std::string::npos);
            return;
        }
        FAIL("accepted");
    };
    const auto with = [](SettingTable table, const char* key, SettingValue value) {
        std::erase_if(table.entries, [&](const SettingAssignment& entry) { return entry.key == key; });
        table.entries.push_back({key, std::move(value), ""});
        return table;
    };
    const SettingTable sphere = table_of("keep", "sphere"), box = table_of("keep", "box");
    refused(with(sphere, "radius", 2.0), "radius_mm");
    refused(with(sphere, "radius_mm", -2.0), "above 0");
    refused(with(sphere, "center_mm", std::vector<double>{1.0}), "3 numbers");
    refused(with(sphere, "shape", std::string("spehre")), "'sphere'");
    refused(with(box, "max_mm", std::vector<double>{-9, 9, 9}), "above min_mm");
    refused(with(table_of("keep", "half_space"), "outward", std::vector<double>{0, 0, 0}), "not zero");
    refused(with(table_of("keep", "triangles"), "triangles", std::vector<double>{1.5}), "number of a triangle");
    refused(with(table_of("keep", "lowest"), "share", 1.5), "at most 1");
    refused(table_of("keeps", "sphere"), "[[keep]]");
    refused({"keep", {}, ""}, "'shape'");
    refused(table_of("loads", "sphere"), "force_n");
}

TEST_CASE("settings: [[object]] changes what it names for the objects it names", "[pipeline]") {
    Settings settings;
    settings.shell.thickness_mm = 2.0;
    const SettingTable table{
        "object",
        {{"match", std::string("lid"), ""}, {"shell.thickness_mm", 3.0, ""}, {"synthesis.seed", std::int64_t{5}, ""}},
        ""};
    apply_table(settings, table);
    apply_table(settings, {"object", {{"match", std::string("7"), ""}, {"synthesis.seed", std::int64_t{6}, ""}}, ""});
    const std::vector<SettingTable> tables = tables_from(settings);
    REQUIRE(tables.size() == 2);
    CHECK(tables[0].array == "object");
    CHECK(tables[0].entries.size() == 3);

    const std::vector<std::string> lid = {"lid", "7"}, other = {"box", "1"};
    const Settings own = settings_for_object(settings, lid);
    CHECK(own.shell.thickness_mm == 3.0);
    CHECK(own.synthesis.search.seed == 6);  // The later entry wins.
    CHECK(own.objects.empty());
    CHECK(settings_for_object(settings, other).shell.thickness_mm == 2.0);
    CHECK(settings_for_object(settings, other).synthesis.search.seed == 1);

    for (const SettingTable& wrong :
         {SettingTable{"object", {{"synthesis.seed", std::int64_t{5}, ""}}, "s.toml: line 1"},
          SettingTable{"object", {{"match", std::int64_t{5}, "s.toml: line 2"}}, "s.toml: line 1"},
          SettingTable{"object", {{"match", std::string("a"), ""}, {"shell.thick", 3.0, "s.toml: line 3"}}, ""},
          SettingTable{
              "object", {{"match", std::string("a"), ""}, {"output.paint", std::string("prusa"), "s.toml: l"}}, ""},
          SettingTable{"object", {{"match", std::string("a"), ""}, {"shell.thickness_mm", -3.0, "s.toml: l"}}, ""}}) {
        Settings untouched;
        CHECK_THROWS_WITH(apply_table(untouched, wrong), Catch::StartsWith("s.toml: l"));
    }
}

}  // namespace
}  // namespace fretwork
