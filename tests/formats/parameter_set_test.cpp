// OpenSCAD Customizer parameter sets.
#include <catch2/catch.hpp>

#include "core/base/error.h"
#include "formats/parameter_set_reader.h"

namespace fretwork {
namespace {

const std::string kSets =
    "{\n \"parameterSets\": {\n  \"dense\": {\"shell.thickness_mm\": \"2.5\", \"seed\": 7, \"invert\": true},\n"
    "  \"coarse\": {}\n },\n \"fileFormatVersion\": \"1\"\n}\n";

TEST_CASE("parameter sets: values come as text, whatever their kind in the file", "[formats]") {
    CHECK(list_parameter_sets(kSets, "p.json") == std::vector<std::string>{"coarse", "dense"});
    const auto dense = read_parameter_set(kSets, "p.json", "dense");
    REQUIRE(dense.size() == 3);
    CHECK(dense[0].key == "invert");
    CHECK(std::get<std::string>(dense[0].value) == "true");
    CHECK(std::get<std::string>(dense[1].value) == "7");
    CHECK(std::get<std::string>(dense[2].value) == "2.5");
    CHECK(dense[2].place == "p.json: set \"dense\"");
    CHECK(read_parameter_set(kSets, "p.json", "coarse").empty());
}

TEST_CASE("parameter sets: an unknown set and other mistakes are errors", "[formats][errors]") {
    CHECK_THROWS_AS(read_parameter_set(kSets, "p.json", "fine"), InvalidSetting);
    CHECK_THROWS_WITH(read_parameter_set(kSets, "p.json", "fine"),
                      Catch::Contains("\"fine\"") && Catch::Contains("coarse, dense"));
    struct Row {
        std::string text, message;
    };
    const std::vector<Row> rows = {
        {"", "line 1, column 1"},
        {"{\n \"parameterSets\": {\n  oops", "line 3"},
        {"[]", "parameterSets"},
        {"{\"parameterSets\": 3}", "parameterSets"},
        {"{\"parameterSets\": {\"s\": {\"a\": [1]}}}", "a: found array"},
        {"{\"parameterSets\": {\"s\": 1}}", "found number"},
        {"{\"parameterSets\": {\"s\": {}}, \"fileFormatVersion\": \"2\"}", "fileFormatVersion"},
        {"{\"parameterSets\": {\"s\": {\"a\": 1e999}}}", "beyond 1e308"},
        {std::string(100000, '['), "found"},
        {std::string(2 << 20, ' '), "1 MiB"},
    };
    for (const Row& row : rows) {
        CAPTURE(row.text.substr(0, 60));
        CHECK_THROWS_AS(read_parameter_set(row.text, "p.json", "s"), InvalidInput);
        CHECK_THROWS_WITH(read_parameter_set(row.text, "p.json", "s"),
                          Catch::StartsWith("p.json: ") && Catch::Contains(row.message));
    }
}

}  // namespace
}  // namespace fretwork
