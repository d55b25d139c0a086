// Promise 7: whatever in the input package is not carved comes out unchanged.
#include "formats/threemf_editor.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <regex>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "formats/threemf_layout.h"
#include "formats/threemf_objects.h"
#include "formats/threemf_reader.h"
#include "formats/volumetric_reader.h"
#include "formats/zip_reader.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

using testing::make_box;
using testing::make_icosphere;
using testing::make_model;
using testing::make_package;
using testing::make_project;
using testing::make_tetrahedron;
using testing::Parts;
using testing::ProjectGaps;
using testing::volume_mm3;
using threemf::ObjectKey;

const std::string kRoot = "3D/3dmodel.model";

std::string part_of(const std::string& package, const std::string& name) {
    return ZipReader(package, "p").read(name, 1 << 26);
}

std::string before(const std::string& text, const std::string& mark) {
    const std::size_t at = text.find(mark);
    REQUIRE(at != text.npos);
    return text.substr(0, at);
}

std::string after(const std::string& text, const std::string& mark) {
    const std::size_t at = text.find(mark);
    REQUIRE(at != text.npos);
    return text.substr(at + mark.size());
}

/// The package with these objects turned into a box of 2 mm in two colours.
struct Carving {
    TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(2, 2, 2));
    std::vector<Rgb8> colors = std::vector<Rgb8>(12, Rgb8{1, 2, 3});
    SurfaceVoxels shell;
    SolidStates solid = {SolidState::kSolid};
    VoxelSheets sheets;
    PackageRecord record;

    Carving() {
        colors[5] = {200, 100, 0};
        shell.grid.extent = {3, 4, 2};
        shell.coords = {{2, 0, 1}};
        sheets = make_voxel_sheets({shell, solid, {}, {}});
    }

    [[nodiscard]] std::string of(const std::string& package, const std::vector<ObjectKey>& keys) const {
        ThreemfEdit edit;
        for (const ObjectKey& key : keys) edit.objects.push_back({key, {box, colors, "", nullptr, &sheets}});
        edit.record = record;
        return ThreemfEditor(package, "p", keys).write(edit);
    }
};

TEST_CASE("3mf editor: the text around a carved mesh stays byte for byte", "[formats][threemf][lossless]") {
    const std::string input = make_project(), output = Carving().of(input, {{kRoot, 5}});
    const std::string xml = part_of(output, kRoot);
    // The project is a text with gaps; carving fills them and nothing else. Its own ids end at 61.
    ProjectGaps gaps;
    gaps.model =
        " xmlns:m2=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\""
        " xmlns:v=\"http://schemas.3mf.io/3dmanufacturing/volumetric/2022/01\""
        " xmlns:fw=\"http://fretwork.dev/3mf/2026/11\"";
    gaps.recommended = "x m2 v";
    gaps.before_object = before(after(xml, "<!-- the wall -->"), "<object");
    gaps.object = " pid=\"62\" pindex=\"0\"";
    gaps.mesh = " v:volumeid=\"65\"";
    gaps.mesh_content = before(after(xml, "<mesh x:keep='a>b' v:volumeid=\"65\">"), "</mesh>");
    const std::string expected = part_of(make_project(gaps), kRoot);
    CHECK((xml == expected));
    CHECK_THAT(gaps.before_object, Catch::Contains("<m2:colorgroup id=\"62\">") &&
                                       Catch::Contains("<v:image3d id=\"63\"") &&
                                       Catch::Contains("<v:volumedata id=\"65\">"));
    CHECK_THAT(gaps.mesh_content, Catch::StartsWith("<vertices>") && Catch::EndsWith("</triangles>"));
}

TEST_CASE("3mf editor: every part that is not carved is copied as it is packed, in its order",
          "[formats][threemf][lossless]") {
    const std::string input = make_project(), output = Carving().of(input, {{kRoot, 5}});
    const ZipReader from(input, "in"), to(output, "out");
    const std::set<std::string> changed = {"[Content_Types].xml", "_rels/.rels", kRoot, "3D/_rels/3dmodel.model.rels"};
    REQUIRE(from.entries().size() > 10);
    REQUIRE(to.entries().size() == from.entries().size() + 2);  // Two sheets.
    for (std::size_t i = 0; i < from.entries().size(); ++i) {
        const std::string& name = from.entries()[i].name;
        CAPTURE(name);
        CHECK(to.entries()[i].name == name);
        if (changed.contains(name)) continue;
        const PackedPart a = from.read_packed(name), b = to.read_packed(name);
        CHECK(a.stored == b.stored);
        CHECK((a.data.blocks == b.data.blocks));
        CHECK(from.read(name, 1 << 20) == to.read(name, 1 << 20));
    }
    // Of the parts that hold the package together, what was there is there.
    for (const char* name : {"[Content_Types].xml", "_rels/.rels", "3D/_rels/3dmodel.model.rels"}) {
        const std::string a = from.read(name, 1 << 20), b = to.read(name, 1 << 20);
        const std::size_t end = a.rfind("</");
        CAPTURE(name);
        CHECK(b.starts_with(a.substr(0, end)));
        CHECK(b.ends_with(a.substr(end)));
    }
    CHECK_THAT(to.read("[Content_Types].xml", 1 << 20), !Catch::Contains("Extension=\"model\"\" ContentType=\"text"));
    CHECK_THAT(to.read("3D/_rels/3dmodel.model.rels", 1 << 20),
               Catch::Contains("Target=\"/3D/volumetric/voxels/sheet0001.png\""));
}

TEST_CASE("3mf editor: nothing carved, nothing changed but the record", "[formats][threemf][lossless]") {
    const std::string input = make_project();
    CHECK((part_of(Carving().of(input, {}), kRoot) == part_of(input, kRoot)));
    Carving noted;
    noted.record.metadata = {{"fw:seed", "7"}};
    noted.record.spec_toml = "a = \"\xC2\xB5\"\n";
    const std::string once = noted.of(input, {});
    const std::string xml = part_of(once, kRoot);
    CHECK_THAT(xml, Catch::Contains("<metadata name=\"fw:seed\">7</metadata>") &&
                        Catch::Contains("<metadata name=\"fw:spec\">a = &quot;&#181;&quot;\n</metadata>"));
    CHECK(part_of(once, "Metadata/fretwork.toml") == noted.record.spec_toml);
    CHECK_THAT(part_of(once, "_rels/.rels"), Catch::Contains("Target=\"/Metadata/fretwork.toml\""));
    CHECK_THAT(part_of(once, "[Content_Types].xml"), Catch::Contains("Extension=\"toml\""));
    // A second run takes the place of the first.
    noted.record.metadata = {{"fw:seed", "8"}};
    noted.record.spec_toml = "b = 1\n";
    const std::string twice = noted.of(once, {});
    const std::string text = part_of(twice, kRoot);
    CHECK_THAT(text, Catch::Contains("<metadata name=\"fw:seed\">8</metadata>") && !Catch::Contains(">7</metadata>"));
    CHECK(text.find("fw:spec") == text.rfind("fw:spec"));
    CHECK(part_of(twice, "Metadata/fretwork.toml") == "b = 1\n");
    CHECK((part_of(twice, "_rels/.rels") == part_of(once, "_rels/.rels")));
}

TEST_CASE("3mf editor: what is carved is read back in its place", "[formats][threemf]") {
    const std::string input = make_project();
    const MeshFile was = read_threemf(input, "in");
    const std::string output = Carving().of(input, {{kRoot, 5}});
    const MeshFile file = read_threemf(output, "out");
    REQUIRE(file.parts.size() == was.parts.size());
    // Object 5 is a tetrahedron that is placed twice, as it is and doubled; the box has a volume of 8 in its place.
    CHECK(volume_mm3(file.mesh) - volume_mm3(was.mesh) == Approx((1 + 8) * (8.0 - 1.0 / 6)));
    CHECK(std::count(file.triangle_colors.begin(), file.triangle_colors.end(), Rgb8{200, 100, 0}) == 2);
    const auto objects = read_volumetric_threemf(output, "out");
    REQUIRE(objects.size() == 1);
    CHECK(objects[0].property("fw:solid", Vec3(2.5, 0.5, 1.5)) == 1.0);
    CHECK(objects[0].property("fw:solid", Vec3(1.5, 0.5, 1.5)) == 0.0);
}

TEST_CASE("3mf editor: an object of another model part is carved there", "[formats][threemf][lossless]") {
    const std::string input = make_project();
    const std::string other = "3D/Objects/other.model";
    const std::string output = Carving().of(input, {{other, 1}});
    CHECK((part_of(output, kRoot) == part_of(input, kRoot)));
    CHECK_THAT(part_of(output, other), Catch::Contains("<m:colorgroup id=\"8\">") &&
                                           Catch::Contains("p:UUID=\"u-1\"") &&
                                           Catch::Contains("recommendedextensions=\"m v\""));
    CHECK_THAT(part_of(output, "3D/Objects/_rels/other.model.rels"), Catch::Contains("sheet0000.png"));
    CHECK(volume_mm3(read_threemf(output, "out").mesh) - volume_mm3(read_threemf(input, "in").mesh) ==
          Approx(8.0 - 1.0 / 6));
}

TEST_CASE("3mf editor: several objects of one part keep their own data", "[formats][threemf]") {
    const std::string input = make_project();
    const std::string xml = part_of(Carving().of(input, {{kRoot, 5}, {kRoot, 6}}), kRoot);
    CHECK_THAT(xml, Catch::Contains("<m2:colorgroup id=\"62\">") && Catch::Contains("<m2:colorgroup id=\"66\">") &&
                        Catch::Contains("v:volumeid=\"65\"") && Catch::Contains("v:volumeid=\"69\"") &&
                        Catch::Contains("/3D/volumetric/voxels1/") && Catch::Contains("/3D/volumetric/voxels2/"));
}

TEST_CASE("3mf editor: an object carved before is carved again without a clash", "[formats][threemf]") {
    const Carving carving;
    const std::string once = carving.of(make_project(), {{kRoot, 5}}), twice = carving.of(once, {{kRoot, 5}});
    const std::string xml = part_of(twice, kRoot);
    CHECK_THAT(xml, Catch::Contains("v:volumeid=\"69\"") && !Catch::Contains("v:volumeid=\"65\"") &&
                        Catch::Contains("recommendedextensions=\"x m2 v\""));
    // The stack of the first carve is gone, and the second has its name.
    const std::size_t stack = xml.find("<v:image3d");
    CHECK(stack != xml.npos);
    CHECK(xml.find("<v:image3d", stack + 1) == xml.npos);
    CHECK(ZipReader(twice, "p").entries().size() == ZipReader(once, "p").entries().size());
    CHECK_THAT(xml, Catch::Contains("/3D/volumetric/voxels/") && !Catch::Contains("/3D/volumetric/voxels1/"));
    CHECK(part_of(twice, "3D/_rels/3dmodel.model.rels").size() == part_of(once, "3D/_rels/3dmodel.model.rels").size());
    CHECK(read_volumetric_threemf(twice, "p").size() == 1);
    CHECK(volume_mm3(read_threemf(twice, "p").mesh) == Approx(volume_mm3(read_threemf(once, "p").mesh)));
    // So are its colours; what the project brought along is as it was.
    CHECK_THAT(xml, Catch::Contains("<m2:colorgroup id=\"66\">") && !Catch::Contains("<m2:colorgroup id=\"62\">"));
    CHECK((before(xml, "<!-- the wall -->") == before(part_of(once, kRoot), "<!-- the wall -->")));
    CHECK((after(xml, "</mesh>") == after(part_of(once, kRoot), "</mesh>")));
}

/// A package with `what` written in one part behind the first `where` that follows `from`.
std::string with_text(const std::string& package, const std::string& from, const std::string& where,
                      const std::string& what) {
    Parts parts;
    const ZipReader zip(package, "p");
    for (const auto& entry : zip.entries()) parts.emplace_back(entry.name, part_of(package, entry.name));
    std::string& xml = std::ranges::find(parts, kRoot, &Parts::value_type::first)->second;
    const std::size_t at = xml.find(where, xml.find(from));
    REQUIRE(at != xml.npos);
    xml.insert(at + where.size(), what);
    return testing::make_zip(parts);
}

std::size_t count_of(const std::string& text, const std::string& mark) {
    std::size_t count = 0;
    for (std::size_t at = text.find(mark); at != text.npos; at = text.find(mark, at + 1)) ++count;
    return count;
}

TEST_CASE("3mf editor: colours of an earlier carve go unless others use them, and no others go",
          "[formats][threemf][lossless]") {
    const Carving carving;
    const std::string once = carving.of(make_project(), {{kRoot, 5}});
    const auto groups_after = [&](const std::string& from, const std::string& where, const std::string& what) {
        const std::string package = what.empty() ? once : with_text(once, from, where, what);
        return count_of(part_of(carving.of(package, {{kRoot, 5}}), kRoot), "<m2:colorgroup id=");
    };
    CHECK(groups_after("", "", "") == 1);
    // Another object, one of its triangles, a mixture, and an element of an extension that nobody knows.
    CHECK(groups_after("name=\"post\"", "name=\"post\"", " pid=\"62\" pindex=\"0\"") == 2);
    CHECK(groups_after("name=\"post\"", "<triangle", " pid=\"62\" p1=\"0\"") == 2);
    CHECK(groups_after("", "<resources >", "<m2:multiproperties id=\"90\" pids=\"2 62\"/>") == 2);
    CHECK(groups_after("", "<resources >", "<x:thing id=\"90\" x:fillid=\"62\"/>") == 2);
    CHECK(groups_after("", "<resources >", "<x:thing id=\"90\" x:fillid=\"620\"/>") == 1);
    // A group of the user's own that the object had before it was carved.
    const std::string own = "<m2:colorgroup id=\"91\"><m2:color color=\"#010203\"/></m2:colorgroup>";
    CHECK(groups_after("<!-- the wall -->", "<!-- the wall -->", own) == 2);
    CHECK(groups_after("<v:image3d", "</v:volumedata>\n", own) == 2);

    // Carved without colours, the object names no group that is gone.
    ThreemfEdit edit;
    edit.objects.push_back({{kRoot, 5}, {carving.box, {}, "", nullptr, &carving.sheets}});
    const std::string plain = part_of(ThreemfEditor(once, "p", {{kRoot, 5}}).write(edit), kRoot);
    CHECK(count_of(plain, "<m2:colorgroup id=") == 0);
    CHECK_THAT(plain, Catch::Contains("x:more=\"&quot;\"><metadatagroup>"));
    // One of the user's stays named.
    const std::string red = with_text(make_project(), "name='wall'", "name='wall'", " pid=\"2\" pindex=\"0\"");
    CHECK_THAT(part_of(ThreemfEditor(red, "p", {{kRoot, 5}}).write(edit), kRoot),
               Catch::Contains("name='wall' pid=\"2\" pindex=\"0\""));
}

TEST_CASE("3mf editor: every image stack of an earlier carve goes, and names that are taken are not used again",
          "[formats][threemf]") {
    Carving carving;
    const std::vector<std::uint8_t> reinforced = {1};
    const std::vector<float> stress_mpa = {2.5F};
    const std::vector<std::uint16_t> labels = {7};
    carving.sheets = make_voxel_sheets({carving.shell, carving.solid, reinforced, {}, stress_mpa, labels});
    const auto sheet_names = [](const std::string& package) {
        std::vector<std::string> names;
        const ZipReader zip(package, "p");
        for (const auto& entry : zip.entries())
            if (entry.name.starts_with("3D/volumetric/")) names.push_back(before(entry.name, "/sheet"));
        std::ranges::sort(names);
        names.erase(std::unique(names.begin(), names.end()), names.end());
        return names;
    };
    const std::string once = carving.of(make_project(), {{kRoot, 5}});
    REQUIRE(sheet_names(once) ==
            std::vector<std::string>{"3D/volumetric/facts", "3D/volumetric/reinforced", "3D/volumetric/voxels"});
    // The second carve knows less: nothing of what only the first knew stays.
    const std::string twice = Carving().of(once, {{kRoot, 5}});
    CHECK(sheet_names(twice) == std::vector<std::string>{"3D/volumetric/voxels"});
    CHECK(part_of(twice, kRoot).find("fw:stress") == std::string::npos);
    CHECK(sheet_names(carving.of(twice, {{kRoot, 5}})) == sheet_names(once));

    const char* stack = GENERATE("facts", "reinforced", "VOXELS");
    CAPTURE(stack);
    Parts parts;
    const std::string project = make_project();
    const ZipReader zip(project, "p");
    for (const auto& entry : zip.entries()) parts.emplace_back(entry.name, part_of(project, entry.name));
    const std::string taken = std::string("3D/volumetric/") + stack + "/sheet0000.png";
    parts.emplace_back(taken, "not ours");
    const std::string beside = carving.of(testing::make_zip(parts), {{kRoot, 5}});
    CHECK(part_of(beside, taken) == "not ours");
    CHECK_THAT(part_of(beside, kRoot), Catch::Contains("/3D/volumetric/facts1/"));
}

TEST_CASE("3mf editor: voxel data that others use, or that are not ours, stay in an object carved again",
          "[formats][threemf][lossless]") {
    const Carving carving;
    const std::string once = carving.of(make_project(), {{kRoot, 5}});
    /// Image stacks after a second carve, with `what` written behind the first `where` that follows `from` in between.
    const auto stacks_after = [&](const std::string& from, const std::string& where, const std::string& what) {
        return count_of(part_of(carving.of(with_text(once, from, where, what), {{kRoot, 5}}), kRoot), "<v:image3d");
    };
    CHECK(stacks_after("<v:image3d", "<v:image3d", "") == 1);
    CHECK(stacks_after("name=\"spare\"", "<mesh", " v:volumeid=\"65\"") == 2);   // another object has them too
    CHECK(stacks_after("<v:volumedata", "name=\"fw:", "none\" xname=\"") == 1);  // still a property of ours
    CHECK(stacks_after("<v:imagesheet", "/3D/volumetric/", "others/") == 2);     // a stack that is not where ours are
}

TEST_CASE("3mf editor: prefixes, units and encodings of the part are kept to", "[formats][threemf]") {
    // The core namespace has a prefix here, the unit is the inch.
    const std::string prefixed =
        "<?xml version='1.0'?>\n<c:model xmlns:c=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
        "unit=\"inch\"><c:resources><c:object id=\"1\"><c:mesh><c:vertices><c:vertex x=\"0\" y=\"0\" z=\"0\"/>"
        "<c:vertex x=\"1\" y=\"0\" z=\"0\"/><c:vertex x=\"0\" y=\"1\" z=\"0\"/><c:vertex x=\"0\" y=\"0\" z=\"1\"/>"
        "</c:vertices><c:triangles><c:triangle v1=\"0\" v2=\"2\" v3=\"1\"/><c:triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"
        "<c:triangle v1=\"0\" v2=\"3\" v3=\"2\"/><c:triangle v1=\"1\" v2=\"2\" v3=\"3\"/></c:triangles></c:mesh>"
        "</c:object></c:resources><c:build><c:item objectid=\"1\"/></c:build></c:model>";
    const std::string output = Carving().of(make_package(prefixed), {{kRoot, 1}});
    CHECK(volume_mm3(read_threemf(output, "p").mesh) == Approx(8.0).epsilon(1e-6));
    CHECK(read_volumetric_threemf(output, "p").at(0).property("fw:solid", Vec3(2.5, 0.5, 1.5)) == 1.0);

    std::string utf16 = "\xFF\xFE";
    for (const char c : make_model(make_tetrahedron(1, "name=\"w\""), "<item objectid=\"1\"/>")) utf16 += {c, '\0'};
    CHECK(volume_mm3(read_threemf(Carving().of(make_package(utf16), {{kRoot, 1}}), "p").mesh) == Approx(8.0));
}

TEST_CASE("3mf editor: the package's picture is replaced, other pictures stay", "[formats][threemf][lossless]") {
    Carving carving;
    carving.record.thumbnail_png = "new picture";
    const std::string input = make_project();
    const std::string output = carving.of(input, {{kRoot, 5}});
    CHECK(part_of(output, "Metadata/thumbnail.png") == "new picture");
    CHECK(part_of(output, "Metadata/plate_1.png") == part_of(input, "Metadata/plate_1.png"));
    // Where there was none it gets a relationship and a type.
    const std::string bare = make_package(make_model(make_tetrahedron(1), "<item objectid=\"1\"/>"));
    const std::string pictured = carving.of(bare, {{kRoot, 1}});
    CHECK_THAT(part_of(pictured, "_rels/.rels"), Catch::Contains("Target=\"/Metadata/thumbnail.png\""));
    CHECK_THAT(part_of(pictured, "[Content_Types].xml"), Catch::Contains("Extension=\"png\""));
}

TEST_CASE("3mf editor: paint is written as the part spells the slicer's namespace", "[formats][threemf]") {
    const Carving carving;
    const std::vector<std::uint8_t> extruders(12, 2);
    const auto painted = [&](const std::string& input, threemf::ResourceId id) {
        ThreemfEdit edit;
        edit.objects.push_back(
            {{kRoot, id}, {carving.box, {}, "", nullptr, nullptr, {PaintFormat::kPrusa, extruders}}});
        return part_of(ThreemfEditor(input, "p", {{kRoot, id}}).write(edit), kRoot);
    };
    // The project declares slic3rpe itself; a model that does not gets it, with what the slicer needs to know.
    const std::string in_project = painted(make_project(), 5);
    CHECK_THAT(in_project, Catch::Contains("<metadata name=\"slic3rpe:MmPaintingVersion\">1</metadata>"));
    const std::regex painted_triangle(
        "<triangle v1=\"\\d+\" v2=\"\\d+\" v3=\"\\d+\" slic3rpe:mmu_segmentation=\"8\"/>");
    CHECK(std::distance(std::sregex_iterator(in_project.begin(), in_project.end(), painted_triangle),
                        std::sregex_iterator()) == 12);
    CHECK(in_project.find("xmlns:slic3rpe=") == in_project.rfind("xmlns:slic3rpe="));
    const std::string bare = make_package(make_model(make_tetrahedron(1), "<item objectid=\"1\"/>"));
    CHECK_THAT(painted(bare, 1), Catch::Contains("xmlns:slic3rpe=\"http://schemas.slic3r.org/3mf/2017/06\""));
}

TEST_CASE("3mf editor: PrusaSlicer's runs of triangles follow the carved mesh", "[formats][threemf]") {
    const std::string config =
        "<config>\n <object id=\"1\" instances_count=\"1\"><metadata type=\"object\" key=\"name\" value=\"a\"/>\n"
        "  <volume firstid=\"0\" lastid=\"1\"><metadata type=\"volume\" key=\"extruder\" value=\"2\"/></volume>\n"
        "  <volume firstid=\"2\" lastid=\"3\"></volume></object>\n"
        " <object id=\"2\"><volume firstid=\"0\" lastid=\"3\"/></object>\n</config>";
    const std::string input = make_package(
        make_model(make_tetrahedron(1) + make_tetrahedron(2), "<item objectid=\"1\"/><item objectid=\"2\"/>"),
        {{"Metadata/Slic3r_PE_model.config", config}});
    const ThreemfEditor editor(input, "p", {{kRoot, 1}});
    REQUIRE(editor.warnings().size() == 1);
    CHECK_THAT(editor.warnings()[0], Catch::Contains("2 volumes"));
    const std::string output = part_of(Carving().of(input, {{kRoot, 1}}), "Metadata/Slic3r_PE_model.config");
    CHECK(output == std::regex_replace(std::regex_replace(config, std::regex("lastid=\"1\""), "lastid=\"11\""),
                                       std::regex("<volume firstid=\"2\" lastid=\"3\"></volume>"), ""));
}

TEST_CASE("3mf editor: a mesh that holds a modifier of PrusaSlicer is not carved", "[formats][threemf][errors]") {
    const std::string config =
        "<config><object id=\"1\"><volume firstid=\"0\" lastid=\"1\"><metadata type=\"volume\" key=\"volume_type\" "
        "value=\"ModelPart\"/></volume><volume firstid=\"2\" lastid=\"3\"><metadata type=\"volume\" "
        "key=\"volume_type\" value=\"ParameterModifier\"/></volume></object></config>";
    const std::string input = make_package(
        make_model(make_tetrahedron(1) + make_tetrahedron(2), "<item objectid=\"1\"/><item objectid=\"2\"/>"),
        {{"Metadata/Slic3r_PE_model.config", config}});
    CHECK_THROWS_WITH(ThreemfEditor(input, "p", {{kRoot, 1}}), Catch::Contains("ParameterModifier"));
    CHECK((part_of(Carving().of(input, {{kRoot, 2}}), "Metadata/Slic3r_PE_model.config") == config));
}

TEST_CASE("3mf editor: what refers to carved triangles is named", "[formats][threemf]") {
    std::string object = make_tetrahedron(1);
    object.insert(object.find("</mesh>"), "<fw:sets><fw:set/></fw:sets>");
    const std::string input = make_package(make_model(object, "<item objectid=\"1\"/>"));
    const ThreemfEditor editor(input, "p", {{kRoot, 1}});
    REQUIRE(editor.warnings().size() == 1);
    CHECK_THAT(editor.warnings()[0], Catch::Contains("<sets>"));
    CHECK_THROWS_WITH(ThreemfEditor(input, "p", {{kRoot, 9}}), Catch::Contains("no object 9"));
    CHECK_THROWS_AS(ThreemfEditor(input, "p", {{kRoot, 1}}).write({}), InvalidInput);
}

/// Two boxes; the second with more on its object and in its mesh, and after them further resources.
std::string with_extension(const std::string& space, const std::string& attributes, const std::string& in_mesh,
                           const std::string& resources, const std::string& items = "") {
    std::string second = testing::make_mesh_object(2, make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), attributes);
    second.insert(second.find("</mesh>"), in_mesh);
    return make_package(make_model(make_tetrahedron(1) + second + resources,
                                   "<item objectid=\"1\"/><item objectid=\"2\"/>" + items,
                                   "xmlns:e=\"" + space + "\" "));
}

TEST_CASE("3mf editor: beam lattices, slices, displacement and boolean shapes are carried along",
          "[formats][threemf][lossless]") {
    const std::string lattice =
        "<e:beamlattice radius=\"1\"><e:beams><e:beam v1=\"0\" v2=\"7\"/></e:beams></e:beamlattice>";
    const std::string slices =
        "<e:slicestack id=\"9\"><e:slice ztop=\"1\"><e:vertices><e:vertex x=\"0\" y=\"0\"/>"
        "</e:vertices><e:polygon startv=\"0\"/></e:slice></e:slicestack>";
    const std::string displaced =
        "<e:displacement2d id=\"7\" path=\"/3D/d.png\"/><object id=\"3\"><e:displacementmesh>"
        "<e:triangles did=\"8\"/></e:displacementmesh></object>";
    const std::string boolean =
        "<object id=\"3\"><e:booleanshape objectid=\"1\" operation=\"difference\"><e:boolean "
        "objectid=\"2\"/></e:booleanshape></object>";
    const std::string root = "http://schemas.microsoft.com/3dmanufacturing/";
    const std::vector<std::string> inputs = {
        with_extension(root + "beamlattice/2017/02", "", lattice, ""),
        with_extension(root + "slice/2015/07", "e:slicestackid=\"9\" e:meshresolution=\"lowres\"", "", slices),
        with_extension("http://schemas.3mf.io/3dmanufacturing/displacement/2023/10", "", "", displaced),
        with_extension("http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07", "", "", boolean)};
    for (const std::string& input : inputs) {
        const std::string was = part_of(input, kRoot), is = part_of(Carving().of(input, {{kRoot, 1}}), kRoot);
        CHECK((after(is, "</mesh></object>") == after(was, "</mesh></object>")));
        CHECK(ThreemfEditor(input, "p", {{kRoot, 1}}).warnings().empty());
    }
    // What shows a carved object as it was goes, by name.
    for (const std::size_t i : {0u, 1u}) {
        const ThreemfEditor editor(inputs[i], "p", {{kRoot, 2}});
        REQUIRE(editor.warnings().size() == 1);
        CHECK_THAT(editor.warnings()[0], Catch::Contains(i == 0 ? "<beamlattice>" : "its slices"));
        const std::string is = part_of(Carving().of(inputs[i], {{kRoot, 2}}), kRoot);
        CHECK_THAT(is, !Catch::Contains("slicestackid") && !Catch::Contains("meshresolution"));
        CHECK(is.find("<e:slicestack id=\"9\">") == (i == 0 ? is.npos : is.find("<e:slicestack")));
    }
    // A shape that is not read but built is told of, and stays.
    const std::string built = with_extension("http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07", "", "",
                                             boolean, "<item objectid=\"3\"/>");
    const MeshFile file = read_threemf(built, "p");
    REQUIRE(file.warnings.size() == 1);
    CHECK_THAT(file.warnings[0], Catch::Contains("object 3 has no triangles"));
    CHECK_THAT(part_of(Carving().of(built, {{kRoot, 1}}), kRoot), Catch::Contains(boolean));
}

TEST_CASE("3mf editor: a damaged model text is refused, or carved into a package that reads",
          "[formats][threemf][errors]") {
    const std::string sound = part_of(make_project(), kRoot);
    const Carving carving;
    const std::string other = part_of(make_project(), "3D/Objects/other.model");
    std::size_t carved = 0;
    for (std::size_t at = 0; at < sound.size(); ++at) {
        std::string text = sound;
        text[at] = "<>\"'/:x &"[at % 9];
        CAPTURE(at, text.substr(at < 20 ? 0 : at - 20, 40));
        const std::string package = make_package(text, {{"3D/Objects/other.model", other}});
        ThreemfObjects found;
        try {
            found = read_threemf_objects(package, "p");
        } catch (const InvalidInput&) {
            continue;
        }
        const auto wall = std::ranges::find(found.objects, ObjectKey{kRoot, 5}, &ThreemfObject::key);
        if (wall == found.objects.end()) continue;
        const std::string output = carving.of(package, {{kRoot, 5}});
        const ThreemfObjects again = read_threemf_objects(output, "p");
        REQUIRE(again.objects.size() == found.objects.size());
        for (std::size_t i = 0; i < again.objects.size(); ++i) {
            CHECK(again.objects[i].key == found.objects[i].key);
            const bool is_wall = again.objects[i].key == ObjectKey{kRoot, 5};
            CHECK(again.objects[i].mesh.triangles.size() == (is_wall ? 12 : found.objects[i].mesh.triangles.size()));
        }
        ++carved;
    }
    CHECK(carved > 300);
}

TEST_CASE("3mf editor: the bytes do not depend on threads", "[formats][threemf][determinism]") {
    const std::string input = make_project();
    Carving carving;
    carving.box = make_icosphere(5.0, 6);  // More triangles than one piece of the text holds.
    carving.colors.assign(carving.box.triangles.size(), Rgb8{9, 9, 9});
    const std::string bytes = carving.of(input, {{kRoot, 5}});
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        CHECK((carving.of(input, {{kRoot, 5}}) == bytes));
    }
}

TEST_CASE("3mf objects: each mesh once, with its names and where it is placed", "[formats][threemf]") {
    const ThreemfObjects found = read_threemf_objects(make_project(), "p");
    std::map<std::string, const ThreemfObject*> by_name;
    for (const ThreemfObject& object : found.objects) by_name[object.name] = &object;
    REQUIRE(by_name.size() == 4);
    const ThreemfObject& wall = *by_name.at("wall");
    CHECK(wall.key == ObjectKey{kRoot, 5});
    CHECK(wall.part_number == "W-1");
    CHECK(wall.instances == 2);
    CHECK(wall.printable);
    CHECK(wall.least_scale == Approx(1.0));
    CHECK(wall.most_scale == Approx(2.0));
    CHECK(wall.parent_names == std::vector<std::string>{"pair"});
    CHECK(by_name.at("post")->type == "support");
    CHECK_FALSE(by_name.at("spare")->printable);
    CHECK(by_name.at("far")->key == ObjectKey{"3D/Objects/other.model", 1});
    CHECK(by_name.at("spare")->mesh.triangles.size() == 4);
}

}  // namespace
}  // namespace fretwork
