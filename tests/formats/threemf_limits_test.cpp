// What a 3MF may hold at most, one past each limit; and packages that lack what they should have.
#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "core/base/error.h"
#include "formats/threemf_names.h"
#include "formats/threemf_objects.h"
#include "formats/threemf_reader.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

using testing::make_mesh_object;
using testing::make_model;
using testing::make_package;
using testing::make_tetrahedron;
using testing::make_zip;

const std::string kItem = "<item objectid=\"1\"/>";

/// Texts of numbers that differ enough to keep to the packing ratio.
std::string numbered(int count, const std::function<std::string(const std::string& number)>& text) {
    std::string all;
    for (int i = 0; i < count; ++i)
        all += text(std::to_string(static_cast<unsigned>(i) * 2654435761u % 2147483647u + 2));
    return all;
}

struct Limit {
    std::string name;
    std::string most;  ///< a package at the limit, which is read; may be empty
    std::string over;  ///< one past it
    std::string found;
};

/// A package with this before its only object.
std::string with_head(const std::string& xml) {
    return make_package(make_model(xml + make_tetrahedron(1), kItem));
}

/// A package with this in front of its resources.
std::string with_metadata(const std::string& xml) {
    std::string model = make_model(make_tetrahedron(1), kItem);
    model.insert(model.find("<resources>"), xml);
    return make_package(model);
}

std::string nested(int levels) {
    std::string open, close;
    for (int i = 0; i < levels; ++i) open += "<fw:a>", close += "</fw:a>";
    return with_head(open + close);
}

std::string attributes(int count) {
    std::string xml = "<fw:a";
    for (int i = 0; i < count; ++i) xml += " a" + std::to_string(i) + "=\"1\"";
    return with_head(xml + "/>");
}

std::string metadata_text(std::size_t bytes) {
    std::string text = numbered(200000, [](const std::string& number) { return number; });
    text.resize(bytes);
    return with_metadata("<metadata name=\"Title\">" + text + "</metadata>");
}

std::string metadata(int count) {
    return with_metadata(
        numbered(count, [](const std::string& n) { return "<metadata name=\"fw:" + n + "\">" + n + "</metadata>\n"; }));
}

std::string groups(int count) {
    return with_head(
        numbered(count, [](const std::string& number) { return "<m:colorgroup id=\"" + number + "\"/>\n"; }));
}

std::string layers(int count) {
    std::string pids;
    for (int i = 0; i < count; ++i) pids += " 9";
    return with_head("<m:multiproperties id=\"11\" pids=\"" + pids + "\"/>");
}

/// A strip of a thousand triangles, placed so many times.
std::string placed(int count) {
    const TriangleMesh strip = testing::make_thin_plate(10.0, 10.0, 1.0, 15);
    REQUIRE(strip.triangles.size() == 1020);
    return make_package(make_model(make_mesh_object(1, strip), numbered(count, [](const std::string& number) {
                                       return "<item objectid=\"1\" partnumber=\"" + number + "\"/>";
                                   })));
}

std::string parts(int count) {
    testing::Parts more;
    std::string items;
    for (int i = 0; i < count; ++i) {
        const std::string part = "3D/" + std::to_string(i) + ".model";
        more.emplace_back(part, make_model(make_tetrahedron(1), ""));
        items += "<item objectid=\"1\" p:path=\"/" + part + "\"/>";
    }
    return make_package(make_model("", items), more);
}

std::string entries(int count) {
    testing::Parts more;
    for (int i = 0; i < count; ++i) more.emplace_back("x/" + std::to_string(i), "x");
    return make_package(make_model(make_tetrahedron(1), kItem), more);
}

std::string named(const std::string& name) {
    return make_package(make_model(make_tetrahedron(1), kItem), {{name, "x"}});
}

/// The tetrahedron moved along x.
std::string moved(const std::string& x) {
    return make_package(
        make_model(make_tetrahedron(1), "<item objectid=\"1\" transform=\"1000 0 0 0 1 0 0 0 1 " + x + " 0 0\"/>"));
}

std::vector<Limit> limits() {
    const std::string mesh = make_tetrahedron(1),
                      second = mesh.substr(mesh.find("<mesh>"), mesh.find("</object>") - mesh.find("<mesh>"));
    std::string twice = mesh;
    twice.insert(twice.find("</object>"), second);
    const std::string long_name(256, 'n');
    return {
        // <model> and <resources> are two levels more.
        {"depth", nested(62), nested(63), "64 deep"},
        {"attributes", attributes(64), attributes(65), "over 64 attributes"},
        {"element name", with_head("<fw:" + long_name + "/>"), with_head("<fw:" + long_name + "n/>"), "256 bytes"},
        {"text", metadata_text(1 << 20), metadata_text((1 << 20) + 1), "over 1 MiB"},
        {"metadata", metadata(65536), metadata(65537), "65536 metadata"},
        {"resources", groups(65535), groups(65536), "65536 resources"},
        {"layers", layers(32), layers(33), "over 32 pids"},
        {"placed triangles", placed(4112), placed(4113), "placed triangles"},
        {"model parts", "", parts(4096), "4096 model parts"},
        {"entries", entries(19997), entries(19998), "at most 20000"},
        {"entry name", named(std::string(1024, 'n')), named(std::string(1025, 'n')), "overlong"},
        {"entry name of two lines", "", testing::patched(named("twoQlines"), "twoQlines", "two\nlines"), "control"},
        {"placed coordinate", moved("999999000"), moved("999999001"), "placed coordinate"},
        {"meshes", make_package(make_model(mesh, kItem)), make_package(make_model(twice, kItem)), "second mesh"},
    };
}

TEST_CASE("3mf limits: what is at a limit is read, what is past it is refused by name", "[formats][threemf][errors]") {
    for (const Limit& limit : limits()) {
        CAPTURE(limit.name);
        if (!limit.most.empty()) CHECK_NOTHROW(read_threemf(limit.most, "p.3mf"));
        CHECK_THROWS_AS(read_threemf(limit.over, "p.3mf"), InvalidInput);
        CHECK_THROWS_WITH(read_threemf(limit.over, "p.3mf"),
                          Catch::StartsWith("p.3mf: ") && Catch::Contains(limit.found));
    }
}

TEST_CASE("3mf: a package without content types or relationships is read, with a warning", "[formats][threemf]") {
    const std::string model = make_model(make_tetrahedron(1), kItem);
    const MeshFile bare = read_threemf(make_zip({{"3D/3dmodel.model", model}}), "p");
    CHECK(bare.mesh.triangles.size() == 4);
    REQUIRE(bare.warnings.size() == 2);
    CHECK_THAT(bare.warnings[0], Catch::Contains("no relationship"));
    CHECK_THAT(bare.warnings[1], Catch::Contains("[Content_Types].xml"));
    // The relationship counts, not the usual place; one that leads out of the package does not.
    const std::string space = "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"";
    const std::string type = " Type=\"" + std::string(threemf::kModelRelation) + "\"";
    const MeshFile elsewhere = read_threemf(
        make_zip({{"_rels/.rels",
                   "<Relationships " + space + "><Relationship Id=\"a\" TargetMode=\"External\" Target=\"/no\"" + type +
                       "/><Relationship Id=\"b\" Target=\"/odd/place.model\"" + type + "/></Relationships>"},
                  {"3D/3dmodel.model", "not this one"},
                  {"odd/place.model", model}}),
        "p");
    CHECK(elsewhere.mesh.triangles.size() == 4);
}

TEST_CASE("3mf objects: names that slicers keep beside the model", "[formats][threemf]") {
    const std::string model =
        make_model(make_tetrahedron(3) + make_tetrahedron(4, "name=\"own\"") + make_tetrahedron(5),
                   "<item objectid=\"3\"/><item objectid=\"4\"/><item objectid=\"5\"/>");
    const std::string config =
        "<config><object id=\"3\"><volume><metadata key=\"name\" value=\"part of it\"/></volume><metadata "
        "type=\"object\" key=\"name\" value=\"lid\"/></object><object id=\"4\"><metadata key=\"name\" "
        "value=\"other\"/></object><object id=\"5\"><metadata key=\"extruder\" value=\"2\"/></object></config>";
    for (const std::string part : {"Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"}) {
        CAPTURE(part);
        const ThreemfObjects found = read_threemf_objects(make_package(model, {{part, config}}), "p");
        REQUIRE(found.objects.size() == 3);
        CHECK(found.objects[0].name == "lid");
        CHECK(found.objects[1].name == "own");
        CHECK(found.objects[2].name.empty());
        // A configuration that is broken has no names; the model does not mind.
        const ThreemfObjects nameless = read_threemf_objects(make_package(model, {{part, config.substr(0, 90)}}), "p");
        REQUIRE(nameless.objects.size() == 3);
        CHECK(nameless.objects[0].name.empty());
    }
}

TEST_CASE("zip: an entry that announces nothing and holds something is refused", "[formats][zip][hostile]") {
    constexpr std::size_t kUnpackedSize = 24;
    const std::string zip = testing::with_central_field(testing::make_zip({{"a", "hello"}}), kUnpackedSize, 0, 4);
    CHECK_THROWS_AS(ZipReader(zip, "z").read("a", 100), InvalidInput);
    CHECK(ZipReader(testing::make_zip({{"a", ""}}), "z").read("a", 100).empty());
}

}  // namespace
}  // namespace fretwork
