// What is taken from the text of an OpenSCAD file.
#include "formats/scad_source.h"

#include <catch2/catch.hpp>

#include "core/base/error.h"
#include "formats/spec_toml_reader.h"

namespace fretwork {
namespace {

using Names = std::set<std::string, std::less<>>;

TEST_CASE("scad: a spec stands in a comment, and keeps its line numbers", "[formats]") {
    const std::string text =
        "// fretwork\nwidth = 40; /* not it */\n/* fretwork\n[exemplar]\npattern = \"cells\"\n*/\ncube(width);\n";
    const auto spec = spec_in_scad(text, "box.scad");
    REQUIRE(spec);
    const SpecDocument document = read_spec_toml(*spec, "box.scad");
    REQUIRE(document.assignments.size() == 1);
    CHECK(document.assignments[0].key == "exemplar.pattern");
    CHECK(document.assignments[0].place.find("line 5") != std::string::npos);
}

TEST_CASE("scad: what only looks like a spec is none", "[formats]") {
    for (const char* text : {"", "cube(1);", "// /* fretwork\n[a]\n*/", "x = \"/* fretwork\\\"\";\n",
                             "/* fretwork is nice\n*/", "/*\nfretwork\n*/", "/* fretworks\n*/"}) {
        CAPTURE(text);
        CHECK_FALSE(spec_in_scad(text, "a.scad"));
    }
    CHECK(spec_in_scad("/** fretwork **\na = 1*/", "a.scad"));
    CHECK(spec_in_scad("/* fretwork\r\na = 1\r\n*/", "a.scad"));
    CHECK(spec_in_scad("/*fretwork*/", "a.scad"));
}

TEST_CASE("scad: two specs, or one without an end, are refused by line", "[formats][errors]") {
    CHECK_THROWS_WITH(spec_in_scad("/* fretwork\n*/\n\n/* fretwork\n*/", "a.scad"),
                      Catch::Contains("a.scad") && Catch::Contains("line 4"));
    CHECK_THROWS_WITH(spec_in_scad("\n/* fretwork\n", "a.scad"), Catch::Contains("line 2"));
}

TEST_CASE("scad: variables are what the file assigns on its own level", "[formats]") {
    CHECK(variables_of_scad("a = 1; b=[1, c=2];\n// d = 3\n/* e = 4 */ f = \"g = 5\";") == Names{"a", "b", "f"});
    CHECK(variables_of_scad("module m(h = 1) { i = 2; } $fn = 30; j == k; l(n = 3);") == Names{"$fn"});
    CHECK(variables_of_scad("function o(p) = p; q\n = 4; r s = 5; t /* x */ = 6;") == Names{"q", "s", "t"});
    CHECK(variables_of_scad("u = v <= w ? 1 : 2; x = y != z;") == Names{"u", "x"});
}

TEST_CASE("scad: what a file includes, but not what it uses or only mentions", "[formats]") {
    CHECK(included_by_scad(
              "include <a.scad>\nuse <b.scad>\n// include <c.scad>\n/* include <d.scad> */include\n<e/f.scad>;"
              "x = \"include <g.scad>\"; myinclude <h.scad>") == std::vector<std::string>{"a.scad", "e/f.scad"});
    CHECK(included_by_scad("include <open").empty());
}

}  // namespace
}  // namespace fretwork
