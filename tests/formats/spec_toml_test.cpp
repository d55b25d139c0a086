// Specs as TOML: keys, kinds, places, and the way back.
#include <catch2/catch.hpp>
#include <limits>

#include "core/base/error.h"
#include "formats/spec_toml_reader.h"
#include "formats/spec_toml_writer.h"

namespace fretwork {
namespace {

const std::string kSpec =
    "# a comment\n"
    "seed = 7\n"
    "[shell]\n"
    "thickness_mm = 2.5\n"
    "  side = \"inward\"   # and another\n"
    "[structure]\n"
    "gravity = [0, 0, -1.5]\n"
    "soft = true\n"
    "[[structure.loads]]\n"
    "force_n = 10\n"
    "[[keep]]\n"
    "shape = \"box\"\n"
    "min_mm = [1, 2, 3]\n"
    "[[keep]]\n"
    "shape = 'C:\\raw'\n";

TEST_CASE("spec: keys come flat, in the order of the text, with kinds and places", "[formats]") {
    const SpecDocument spec = read_spec_toml(kSpec, "a.toml");
    REQUIRE(spec.assignments.size() == 5);
    CHECK(spec.assignments[0].key == "seed");
    CHECK(std::get<std::int64_t>(spec.assignments[0].value) == 7);
    CHECK(spec.assignments[0].place == "a.toml: line 2, column 1");
    CHECK(spec.assignments[1].key == "shell.thickness_mm");
    CHECK(std::get<double>(spec.assignments[1].value) == 2.5);
    CHECK(spec.assignments[2].place == "a.toml: line 5, column 3");
    CHECK(std::get<std::string>(spec.assignments[2].value) == "inward");
    CHECK(std::get<std::vector<double>>(spec.assignments[3].value) == std::vector<double>{0, 0, -1.5});
    CHECK(std::get<bool>(spec.assignments[4].value));

    REQUIRE(spec.tables.size() == 3);
    CHECK(spec.tables[0].array == "structure.loads");
    CHECK(spec.tables[0].entries.at(0).key == "force_n");
    CHECK(spec.tables[1].array == "keep");
    CHECK(spec.tables[1].entries.at(1).key == "min_mm");
    CHECK(spec.tables[1].entries.at(1).place == "a.toml: line 13, column 1");
    CHECK(std::get<std::string>(spec.tables[2].entries.at(0).value) == "C:\\raw");
}

TEST_CASE("spec: written and read again, nothing has changed", "[formats][property]") {
    SpecDocument spec = read_spec_toml(kSpec, "a.toml");
    spec.assignments.push_back({"odd.\"quoted\"", std::string("tab\t \"quote\" \\ line\n \x01 \xC3\xA9"), ""});
    spec.assignments.push_back({"numbers.tiny", 5e-324, ""});
    spec.assignments.push_back({"numbers.third", 1.0 / 3.0, ""});
    spec.assignments.push_back({"numbers.whole", 3.0, ""});
    spec.assignments.push_back({"numbers.large", -1e300, ""});
    spec.assignments.push_back({"numbers.integer", std::numeric_limits<std::int64_t>::min(), ""});
    spec.assignments.push_back({"numbers.none", std::vector<double>{}, ""});
    const std::string text = write_spec_toml(spec);
    CAPTURE(text);
    const SpecDocument back = read_spec_toml(text, "b.toml");
    REQUIRE(back.assignments.size() == spec.assignments.size());
    for (const SettingAssignment& before : spec.assignments) {
        CAPTURE(before.key);
        // toml++ takes the quotes off a key.
        const std::string key = before.key == "odd.\"quoted\"" ? "odd.\"quoted\"" : before.key;
        bool found = false;
        for (const SettingAssignment& after : back.assignments)
            if (after.key == key) {
                found = true;
                CHECK(after.value == before.value);
            }
        CHECK(found);
    }
    REQUIRE(back.tables.size() == spec.tables.size());
    for (std::size_t i = 0; i < back.tables.size(); ++i) {
        CHECK(back.tables[i].array == spec.tables[i].array);
        REQUIRE(back.tables[i].entries.size() == spec.tables[i].entries.size());
        for (std::size_t k = 0; k < back.tables[i].entries.size(); ++k) {
            CHECK(back.tables[i].entries[k].key == spec.tables[i].entries[k].key);
            CHECK(back.tables[i].entries[k].value == spec.tables[i].entries[k].value);
        }
    }
    CHECK(write_spec_toml(back) == text);
}

TEST_CASE("spec: what cannot be read is named with its place", "[formats][errors]") {
    struct Row {
        std::string text, message;
    };
    std::string deep = "x = 1\n[a";
    for (int i = 0; i < 40; ++i) deep += ".a";
    deep += "]\nb = 1\n";
    const std::vector<Row> rows = {
        {"a = \n", "line 1"},
        {"a = 1\na = 2\n", "line 2"},
        {"[x]\nwhen = 2026-01-01\n", "x.when: found a date"},
        {"a = [1, \"two\"]\n", "a: found a list that holds something else"},
        {"a = [[1, 2], [3]]\n", "a: found a list that holds something else"},
        {"a = inf\n", "not finite"},
        {"a = [1, nan]\n", "not finite"},
        {"[[a]]\n[[a.b]]\nc = 1\n", "a list of tables within another"},
        {deep, "32 deep"},
        {std::string(2 << 20, '#'), "1 MiB"},
        {"a = 1 \xFF\n", "line 1"},
        {"a = " + std::string(5000, '['), "line 1"},
        {"a = 1\n[ = 1e3,", "without a name"},
        {"a = 1\n\xEF\xB8\xBF = 1\n", "line 2"},
        {"\xC7\x80 = 1\n", "line 1"},
    };
    for (const Row& row : rows) {
        CAPTURE(row.text.substr(0, 60));
        CHECK_THROWS_AS(read_spec_toml(row.text, "a.toml"), InvalidSetting);
        CHECK_THROWS_WITH(read_spec_toml(row.text, "a.toml"),
                          Catch::StartsWith("a.toml: ") && Catch::Contains(row.message));
    }
}

}  // namespace
}  // namespace fretwork
