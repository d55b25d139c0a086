// docs/formats.md is true: its table of features shows what reading and writing do, and the tests that its rows name
// are there.
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

#include "core/base/error.h"
#include "formats/mesh_file.h"
#include "formats/read_file.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// Names of the cases and sections of a file of tests, in lower case; empty where there is no such file.
std::vector<std::string> names_in(const std::string& file) {
    std::vector<std::string> names;
    for (const char* folder : {"formats", "cli"}) {
        const fs::path path = fs::path(FRETWORK_REPOSITORY) / "tests" / folder / (file + "_test.cpp");
        if (!fs::exists(path)) continue;
        // Literals that go on in the next line are one.
        const std::string text = std::regex_replace(read_file(path), std::regex("\"\\s*\n\\s*\""), "");
        const std::regex name("(?:TEST_CASE|SECTION)\\(\"([^\"]*)\"");
        for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at)
            names.push_back(lower((*at)[1]));
    }
    return names;
}

/// Last cells of the rows of all tables whose last column is headed "held by".
std::vector<std::string> holding_cells() {
    std::istringstream page(read_file(fs::path(FRETWORK_REPOSITORY) / "docs/formats.md"));
    std::vector<std::string> cells;
    bool within = false;
    for (std::string line; std::getline(page, line);) {
        if (!line.starts_with("|")) {
            within = false;
            continue;
        }
        const std::size_t end = line.rfind(" |"), begin = line.rfind("| ", end) + 2;
        const std::string cell = line.substr(begin, end - begin);
        if (cell == "held by")
            within = true;
        else if (within && !line.starts_with("|---"))
            cells.push_back(cell);
    }
    return cells;
}

struct Holding {
    std::string file;
    std::vector<std::string> phrases;  ///< of names of its cases; none: all of it
};

/// "`file`: a phrase; another. *file*"
std::vector<Holding> holdings_of(const std::string& cell) {
    std::vector<Holding> all;
    const std::regex file("[`*](\\w+)[`*]");
    for (std::sregex_iterator at(cell.begin(), cell.end(), file), end; at != end; ++at) {
        Holding& holding = all.emplace_back(Holding{(*at)[1], {}});
        const auto next = std::next(at);
        const auto begin = static_cast<std::size_t>(at->position() + at->length());
        const std::size_t stop = next == end ? cell.size() : static_cast<std::size_t>(next->position());
        std::istringstream phrases(cell.substr(begin, stop - begin));
        for (std::string phrase; std::getline(phrases, phrase, ';');) {
            const std::size_t first = phrase.find_first_not_of(" :"), last = phrase.find_last_not_of(" .");
            if (first != phrase.npos && first <= last)
                holding.phrases.push_back(lower(phrase.substr(first, last - first + 1)));
        }
    }
    return all;
}

TEST_CASE("format table: every row names tests that exist, by file and by words of their names", "[formats][docs]") {
    const std::vector<std::string> cells = holding_cells();
    CHECK(cells.size() > 30);
    for (const std::string& cell : cells) {
        CAPTURE(cell);
        const std::vector<Holding> holdings = holdings_of(cell);
        CHECK_FALSE(holdings.empty());
        for (const Holding& holding : holdings) {
            CAPTURE(holding.file);
            const std::vector<std::string> names = names_in(holding.file);
            CHECK_FALSE(names.empty());
            for (const std::string& phrase : holding.phrases) {
                CAPTURE(phrase);
                CHECK(std::ranges::any_of(names, [&](const std::string& n) { return n.find(phrase) != n.npos; }));
            }
        }
    }
}

/// Cells of the table of features: by format, then by the head of the column.
std::map<std::string, std::map<std::string, std::string>> told_features() {
    std::istringstream page(read_file(fs::path(FRETWORK_REPOSITORY) / "docs/formats.md"));
    std::map<std::string, std::map<std::string, std::string>> told;
    std::vector<std::string> heads;
    for (std::string line; std::getline(page, line);) {
        std::vector<std::string> cells;
        const std::regex cell("\\| ([^|]*) (?=\\|)");
        for (std::sregex_iterator at(line.begin(), line.end(), cell), end; at != end; ++at) cells.push_back((*at)[1]);
        if (line.starts_with("| format | colours read |"))
            heads = cells;
        else if (cells.size() != heads.size() || cells.empty())
            heads = line.starts_with("|---") ? heads : std::vector<std::string>{};
        else
            for (std::size_t i = 1; i < cells.size(); ++i) told[cells[0]][heads[i]] = cells[i];
    }
    return told;
}

/// Two named parts in the words of each format that can tell them apart, or that should not.
std::string two_parts(MeshFormat format) {
    const std::string points = "0 0 0\n9 0 0\n0 9 0\n0 0 9\n";
    switch (format) {
        case MeshFormat::kStl: {
            const std::string facet =
                "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 0\nendloop\nendfacet\n";
            return "solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n";
        }
        case MeshFormat::kObj:
            return "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\no a\nf 1 2 3\no b\nf 1 2 4\n";
        case MeshFormat::kPly:
            return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 2\nproperty list uchar int vertex_indices\nend_header\n" +
                   points + "3 0 1 2\n3 0 1 3\n";
        case MeshFormat::kOff:
            return "OFF\n4 2 0\n" + points + "3 0 1 2\n3 0 1 3\n";
        case MeshFormat::kAmf: {
            const auto vertex = [](const char* x, const char* y) {
                return std::string("<vertex><coordinates><x>") + x + "</x><y>" + y +
                       "</y><z>0</z></coordinates></vertex>";
            };
            const auto object = [&](const std::string& name) {
                return "<object id=\"" + name + "\"><metadata type=\"name\">" + name + "</metadata><mesh><vertices>" +
                       vertex("0", "0") + vertex("9", "0") + vertex("0", "9") +
                       "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></"
                       "object>";
            };
            return "<amf>" + object("a") + object("b") + "</amf>";
        }
        default:
            return testing::make_package(testing::make_model(
                testing::make_tetrahedron(1, "name=\"a\"") + testing::make_tetrahedron(2, "name=\"b\""),
                "<item objectid=\"1\"/><item objectid=\"2\"/>"));
    }
}

const char* yes_if(bool found) {
    return found ? "yes" : "no";
}

/// What the format does, by the heads of the table.
std::map<std::string, std::string> found_features(MeshFormat format) {
    TriangleMesh box = testing::make_box(Vec3(0, 0, 0), Vec3(3, 2, 1));
    box.positions_mm[7] = Vec3(3.0000000001, 2, 1);
    const std::vector<Rgb8> colors(box.triangles.size(), Rgb8{200, 100, 0});
    const MeshToWrite full{box, colors, "bracket", CoordinatePrecision::kDouble, "b.mtl"};
    const std::string plain = write_mesh({box, {}, "bracket"}, format), written = write_mesh(full, format);
    std::map<std::string, std::string> found;
    if (format == MeshFormat::kGlb) {
        found["colours written"] =
            yes_if(written.find("COLOR_0") != written.npos && plain.find("COLOR_0") == plain.npos);
        found["name written"] = yes_if(plain.find("\"bracket\"") != plain.npos);
        found["doubles written"] = yes_if(written.find("5130") != written.npos);  // a glTF has no type for them
        for (const char* reading : {"colours read", "parts read", "unit of its own"}) found[reading] = "-";
        CHECK_THROWS_AS(read_mesh(plain, format, "m"), InvalidSetting);
        return found;
    }
    MeshReadOptions inches{.unit = LengthUnit::kInch};
    const fs::path folder = fs::temp_directory_path() / ("fretwork_table_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    const fs::path path = folder / ("b." + std::string(mesh_format_name(format)));
    write_mesh(path, full);
    const MeshFile back = read_mesh(path);
    fs::remove_all(folder);
    const MeshFile parts = read_mesh(two_parts(format), format, "m"), scaled = read_mesh(plain, format, "m", inches);
    found["colours read"] = found["colours written"] = yes_if(back.triangle_colors == colors);
    found["parts read"] = yes_if(parts.parts.size() == 2 && parts.parts[1].name == "b");
    found["name written"] = yes_if(back.parts.size() == 1 && back.parts[0].name == "bracket");
    found["doubles written"] =
        yes_if(std::ranges::any_of(back.mesh.positions_mm, [](const Vec3& p) { return p[0] == 3.0000000001; }));
    found["unit of its own"] = yes_if(testing::volume_mm3(scaled.mesh) < 7.0);
    return found;
}

TEST_CASE("format table: every cell of the features is what reading and writing show", "[formats][docs]") {
    const auto told = told_features();
    CHECK(told.size() == 7);
    const std::map<std::string, MeshFormat> formats = {
        {"3MF", MeshFormat::kThreemf}, {"STL", MeshFormat::kStl}, {"OBJ", MeshFormat::kObj}, {"PLY", MeshFormat::kPly},
        {"OFF", MeshFormat::kOff},     {"AMF", MeshFormat::kAmf}, {"GLB", MeshFormat::kGlb}};
    for (const auto& [name, format] : formats) {
        CAPTURE(name);
        REQUIRE(told.contains(name));
        CHECK(told.at(name) == found_features(format));
    }
}

}  // namespace
}  // namespace fretwork
