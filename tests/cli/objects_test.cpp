// 3MF in, 3MF out: which objects are carved, and that nothing else is touched.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/run_program.h"
#include "core/mesh/mesh_report.h"
#include "formats/image_file.h"
#include "formats/mesh_file.h"
#include "formats/threemf_objects.h"
#include "formats/threemf_reader.h"
#include "formats/zip_reader.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork::testing {
namespace {

using Json = nlohmann::json;

const std::string kRoot = "3D/3dmodel.model";

/// Three boxes, a shield that is a support and one that is not printed. "lid" is placed twice, once at double size,
/// through an assembly; "stand" in part number "S-2" only.
std::string three_boxes() {
    const auto box = [](double side) { return make_box(Vec3(0, 0, 0), Vec3(side, side, side)); };
    const std::string resources =
        make_mesh_object(1, box(20.0), "name=\"lid\"") + make_mesh_object(2, box(24.0), "partnumber=\"S-2\"") +
        make_mesh_object(3, box(22.0), "name=\"a, b\"") + make_mesh_object(4, box(10.0), "type=\"support\"") +
        make_mesh_object(5, box(12.0), "name=\"spare\"") +
        "<object id=\"6\" name=\"pair\"><components><component objectid=\"1\"/><component objectid=\"1\" "
        "transform=\"2 0 0 0 2 0 0 0 2 50 0 0\"/></components></object>";
    return make_package(
        make_model(resources,
                   "<item objectid=\"6\"/><item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 60 0\"/><item "
                   "objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 0 120 0\"/><item objectid=\"4\"/><item objectid=\"5\" "
                   "printable=\"0\"/>"),
        {{"Metadata/notes.txt", "keep me"}});
}

std::vector<std::string> carve_line(const std::vector<std::string>& more) {
    std::vector<std::string> line = {"carve"};
    line.insert(line.end(), more.begin(), more.end());
    for (const char* word : {"--pattern", "cells", "--preset", "draft", "--resolution", "32", "-D",
                             "structure.max_iterations=1", "-D", "structure.samples=60"})
        line.emplace_back(word);
    return line;
}

/// The objects of a package whose meshes differ from those of another, by number.
std::vector<std::uint32_t> changed_objects(const std::string& before, const std::string& after) {
    const ThreemfObjects was = read_threemf_objects(before, "before"), is = read_threemf_objects(after, "after");
    REQUIRE(was.objects.size() == is.objects.size());
    std::vector<std::uint32_t> changed;
    for (std::size_t i = 0; i < was.objects.size(); ++i) {
        CHECK(was.objects[i].key == is.objects[i].key);
        if (was.objects[i].mesh.triangles != is.objects[i].mesh.triangles) changed.push_back(is.objects[i].key.id);
    }
    return changed;
}

TEST_CASE("cli: of a 3MF, everything that is printed is carved, each object on its own", "[cli][threemf]") {
    const TemporaryFolder folder;
    const std::string before = three_boxes();
    spit(folder / "in.3mf", before);
    const ProgramResult run = run_program(
        carve_line({folder / "in.3mf", "-o", folder / "out.3mf", "--summary", folder / "out.json", "--no-source"}));
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const std::string after = slurp(folder / "out.3mf");
    CHECK(changed_objects(before, after) == std::vector<std::uint32_t>{1, 2, 3});
    CHECK(ZipReader(after, "out").read("Metadata/notes.txt", 100) == "keep me");
    for (const ThreemfObject& object : read_threemf_objects(after, "out").objects) {
        CAPTURE(object.key.id);
        const MeshReport mesh = report_mesh(object.mesh, CountSelfIntersections::kYes);
        CHECK(mesh.closed_manifold());
        CHECK(mesh.self_intersections == 0);
    }
    const Json report = Json::parse(slurp(folder / "out.json"));
    REQUIRE(report["objects"].size() == 3);
    CHECK(report["objects"][0]["name"] == "lid");
    CHECK(report["objects"][0]["instances"] == 2);
    CHECK(report["objects"][1]["part_number"] == "S-2");
    CHECK(report["objects"][2]["report"]["input"]["mesh"]["max_mm"][0] == 22.0);
    // The report itself is the first one's.
    CHECK(report["input"]["mesh"]["max_mm"][0] == 20.0);
    CHECK(run.err.find("\"lid\": the file places the object at 1 to 2 times its size") != run.err.npos);
}

TEST_CASE("cli: --objects takes names, numbers and part numbers, also of assemblies", "[cli][threemf]") {
    const TemporaryFolder folder;
    const std::string before = three_boxes();
    spit(folder / "in.3mf", before);
    using Row = std::pair<std::vector<std::string>, std::vector<std::uint32_t>>;
    for (const Row& row :
         {Row{{"--objects", "S-2"}, {2}}, Row{{"--objects", "pair"}, {1}}, Row{{"--objects", "3, lid"}, {1, 3}},
          Row{{"--objects", "a, b"}, {3}}, Row{{"--objects", "2", "--objects", "spare"}, {2, 5}}}) {
        CAPTURE(row.first);
        std::vector<std::string> line = carve_line({folder / "in.3mf", "-o", folder / "out.3mf"});
        line.insert(line.end(), row.first.begin(), row.first.end());
        const ProgramResult run = run_program(line);
        CAPTURE(run.err);
        REQUIRE(run.exit_code == 0);
        CHECK(changed_objects(before, slurp(folder / "out.3mf")) == row.second);
    }
}

TEST_CASE("cli: info lists the objects that --objects can name", "[cli][threemf]") {
    const TemporaryFolder folder;
    spit(folder / "in.3mf", three_boxes());
    const Json info = Json::parse(run_program({"info", folder / "in.3mf", "--json"}).out);
    REQUIRE(info["objects"].size() == 5);
    CHECK(info["objects"][0]["name"] == "lid");
    CHECK(info["objects"][0]["instances"] == 2);
    CHECK(info["objects"][1]["part_number"] == "S-2");
    CHECK(info["objects"][1]["id"] == 2);
    CHECK(info["objects"][3]["type"] == "support");
    CHECK(info["objects"][4]["printable"] == false);
}

TEST_CASE("cli: a name that no object has is an error that lists those there are", "[cli][threemf][errors]") {
    const TemporaryFolder folder;
    spit(folder / "in.3mf", three_boxes());
    const ProgramResult run =
        run_program(carve_line({folder / "in.3mf", "-o", folder / "out.3mf", "--objects", "lidd"}));
    CHECK(run.exit_code == 1);
    CHECK(run.err.find("no \"lidd\"") != run.err.npos);
    CHECK(run.err.find("\"lid\" (id 1), object 2 (part number S-2), \"a, b\" (id 3), object 4, \"spare\" (id 5)") !=
          run.err.npos);
    spit(folder / "vase.off", write_mesh({make_vase(50.0, 32, 16)}, MeshFormat::kOff));
    CHECK(run_program(carve_line({folder / "vase.off", "-o", folder / "out.3mf", "--objects", "lid"})).exit_code == 1);
    const std::string unprinted = make_package(
        make_model(make_mesh_object(1, make_icosphere(10.0, 2)), "<item objectid=\"1\" printable=\"0\"/>"));
    spit(folder / "unprinted.3mf", unprinted);
    const ProgramResult none = run_program(carve_line({folder / "unprinted.3mf", "-o", folder / "out.3mf"}));
    CHECK(none.exit_code == 2);
    CHECK(none.err.find("no object that is printed") != none.err.npos);
    CHECK(folder.names() == std::vector<std::string>{"in.3mf", "unprinted.3mf", "vase.off"});
}

TEST_CASE("cli: [[object]] gives an object settings of its own", "[cli][threemf]") {
    const TemporaryFolder folder;
    spit(folder / "in.3mf", three_boxes());
    spit(folder / "s.toml",
         "[exemplar]\npattern = \"cells\"\n[synthesis]\npreset = \"draft\"\n[shell]\nresolution = 32\n"
         "[structure]\nmax_iterations = 1\nsamples = 60\n[[object]]\nmatch = \"lid\"\nshell.thickness_mm = 3.5\n"
         "[[object]]\nmatch = \"S-2\"\n[object.synthesis]\nseed = 9\n[[object]]\nmatch = \"gone\"\n");
    const ProgramResult run = run_program({"carve", folder / "in.3mf", "--pattern", folder / "s.toml", "-o",
                                           folder / "out.3mf", "--summary", folder / "out.json", "--objects", "lid,2"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const Json objects = Json::parse(slurp(folder / "out.json"))["objects"];
    CHECK(objects[0]["report"]["settings"]["shell"]["thickness_mm"] == 3.5);
    CHECK(objects[0]["report"]["seed"] == 1);
    CHECK(objects[1]["report"]["settings"]["shell"]["thickness_mm"] != 3.5);
    CHECK(objects[1]["report"]["seed"] == 9);
    CHECK(run.err.find("match = \"gone\"") != run.err.npos);
    spit(folder / "bad.toml", "[[object]]\nmatch = \"lid\"\nsynthesis.preset = \"fine\"\n");
    const ProgramResult bad = run_program({"spec", "check", folder / "bad.toml"});
    CHECK(bad.exit_code == 1);
    CHECK(bad.err.find("bad.toml: line 3") != bad.err.npos);
}

TEST_CASE("cli: verify of a carved plate judges what was carved of it", "[cli][threemf]") {
    const TemporaryFolder folder;
    spit(folder / "in.3mf", three_boxes());
    spit(folder / "s.toml",
         "[exemplar]\npattern = \"cells\"\n[synthesis]\npreset = \"draft\"\n[shell]\nresolution = 32\n"
         "[structure]\nmax_iterations = 1\nsamples = 60\nmaterial = \"ABS\"\n[[object]]\nmatch = \"S-2\"\n"
         "structure.material = \"PLA\"\nstructure.gravity = [1, 0, 0]\n"
         "structure.weak_regions = 1\n");
    const ProgramResult carved = run_program(
        {"carve", folder / "in.3mf", "--pattern", folder / "s.toml", "-o", folder / "out.3mf", "--objects", "lid,2"});
    CAPTURE(carved.err);
    REQUIRE(carved.exit_code == 0);
    const ProgramResult run = run_program({"verify", folder / "out.3mf", "--json"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const Json strength = Json::parse(run.out)["strength"];
    REQUIRE(strength["objects"].size() == 2);
    const ThreemfObjects made = read_threemf_objects(slurp(folder / "out.3mf"), "out.3mf");
    const auto check = [&](std::size_t i, const char* label, double density, int pulls_along) {
        const Json& object = strength["objects"][i];
        CHECK(object["object"] == label);
        const double volume = report_mesh(made.objects[i].mesh, CountSelfIntersections::kNo).volume_mm3;
        CHECK(object["volume_mm3"].get<double>() == Approx(volume).epsilon(0.15));
        const double weight = object["weight_n"].get<double>();
        CHECK(weight == Approx(object["volume_mm3"].get<double>() * density * 1e-9 * 9.81));
        CHECK(std::abs(object["cases"][0]["applied_n"][pulls_along].get<double>()) == Approx(weight));
    };
    check(0, "\"lid\"", 1040.0, 2);
    check(1, "object 2", 1240.0, 0);
    // Looked for on the model that was carved, which the package keeps.
    CHECK(strength["objects"][1]["cases"].back()["name"].get<std::string>().starts_with("worst case at"));
}

TEST_CASE("cli: --check looks at every object", "[cli][threemf]") {
    const TemporaryFolder folder;
    spit(folder / "in.3mf", three_boxes());
    const ProgramResult run = run_program(carve_line({folder / "in.3mf", "--check", "--summary", "-"}));
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(Json::parse(run.out)["objects"].size() == 3);
    for (const char* label : {"\"lid\": can be carved", "object 2: can be carved", "\"a, b\": can be carved"})
        CHECK(run.err.find(label) != run.err.npos);
}

TEST_CASE("cli: an unknown required extension is named, or let pass", "[cli][threemf][errors]") {
    const TemporaryFolder folder;
    const std::string model =
        make_model(make_mesh_object(1, make_icosphere(10.0, 2), "z:more=\"kept\""), "<item objectid=\"1\"/>",
                   "requiredextensions=\"z\" xmlns:z=\"http://example.com/unknown\"");
    spit(folder / "in.3mf", make_package(model));
    const ProgramResult refused = run_program(carve_line({folder / "in.3mf", "-o", folder / "out.3mf"}));
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("http://example.com/unknown") != refused.err.npos);
    const ProgramResult let =
        run_program(carve_line({folder / "in.3mf", "-o", folder / "out.3mf", "--ignore-required"}));
    CAPTURE(let.err);
    REQUIRE(let.exit_code == 0);
    CHECK(let.err.find("http://example.com/unknown") != let.err.npos);
    const std::string xml = ZipReader(slurp(folder / "out.3mf"), "out").read(kRoot, 1 << 26);
    CHECK(xml.find("requiredextensions=\"z\"") != xml.npos);
    CHECK(xml.find("z:more=\"kept\"") != xml.npos);
}

TEST_CASE("cli: commands that only read a 3MF let a required extension pass as carve does", "[cli][threemf][errors]") {
    const TemporaryFolder folder;
    const std::string model = make_model(make_mesh_object(1, make_icosphere(10.0, 2)), "<item objectid=\"1\"/>",
                                         "requiredextensions=\"z\" xmlns:z=\"http://example.com/unknown\"");
    const std::string in = folder / "in.3mf";
    spit(in, make_package(model));
    const std::vector<std::vector<std::string>> lines = {
        {"convert", in, folder / "out.stl"},
        {"render", in, "-o", folder / "out.png", "--size", "32"},
        {"render", in, "-o", folder / "out.png", "--size", "32", "--colour", "solid"},
        {"verify", in, "--no-strength"},
    };
    for (std::vector<std::string> line : lines) {
        CAPTURE(line);
        const ProgramResult refused = run_program(line);
        CHECK(refused.exit_code == 2);
        CHECK(refused.err.find("--ignore-required") != refused.err.npos);
        line.emplace_back("--ignore-required");
        const ProgramResult let = run_program(line);
        CAPTURE(let.err);
        CHECK(let.exit_code == 0);
        CHECK(let.err.find("http://example.com/unknown") != let.err.npos);
    }
}

TEST_CASE("cli: a 3MF carved into another format shows what the carved 3MF shows", "[cli][threemf]") {
    const TemporaryFolder folder;
    spit(folder / "in.3mf", three_boxes());
    REQUIRE(run_program(carve_line({folder / "in.3mf", "-o", folder / "out.3mf", "--objects", "2"})).exit_code == 0);
    REQUIRE(run_program(carve_line({folder / "in.3mf", "-o", folder / "out.off", "--objects", "2"})).exit_code == 0);
    const MeshFile package = read_mesh(std::filesystem::path(folder / "out.3mf"));
    const MeshFile mesh = read_mesh(std::filesystem::path(folder / "out.off"));
    CHECK(mesh.mesh.triangles == package.mesh.triangles);
    CHECK(volume_mm3(mesh.mesh) == Approx(volume_mm3(package.mesh)).epsilon(1e-5));
}

TEST_CASE("cli: what is kept of a coloured model keeps its colours", "[cli][threemf]") {
    const TemporaryFolder folder;
    const TriangleMesh ball = make_icosphere(15.0, 4);
    std::string object = make_mesh_object(1, ball, "pid=\"9\" pindex=\"0\"");
    spit(folder / "in.3mf",
         make_package(make_model("<m:colorgroup id=\"9\"><m:color color=\"#1020FF\"/></m:colorgroup>" + object,
                                 "<item objectid=\"1\"/>")));
    std::vector<std::string> line = carve_line({folder / "in.3mf", "-o", folder / "out.3mf"});
    spit(folder / "s.toml",
         "[exemplar]\npattern = \"cells\"\n[[keep]]\nshape = \"half_space\"\n"
         "point_mm = [0, 0, -5]\noutward = [0, 0, 1]\n");
    *std::ranges::find(line, "cells") = folder / "s.toml";
    const ProgramResult run = run_program(line);
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const MeshFile carved = read_mesh(std::filesystem::path(folder / "out.3mf"));
    const Rgb8 kept = {0x10, 0x20, 0xFF};
    std::size_t below = 0, above = 0;
    for (std::size_t t = 0; t < carved.mesh.triangles.size(); ++t) {
        Vec3 middle = Vec3::Zero();
        for (const std::uint32_t v : carved.mesh.triangles[t]) middle += carved.mesh.positions_mm[v] / 3.0;
        // A voxel is about a millimetre here.
        if (middle[2] < -6.5) {
            ++below;
            CHECK(carved.triangle_colors[t] == kept);
        } else if (middle[2] > -3.5) {
            ++above;
            CHECK(carved.triangle_colors[t] != kept);
        }
    }
    CHECK(below > 20);
    CHECK(above > 100);
}

bool slicer_is_there() {
    if (std::system("command -v prusa-slicer > /dev/null 2>&1") == 0) return true;
    WARN("prusa-slicer is not installed: skipped");
    return false;
}

std::string slicer(const TemporaryFolder& folder, const std::string& arguments) {
    const std::string line = "timeout 110 prusa-slicer " + arguments + " > " + (folder / "said") + " 2>&1";
    CHECK(std::system(line.c_str()) == 0);
    return slurp(folder / "said");
}

TEST_CASE("cli: PrusaSlicer loads what it wrote itself after it was carved", "[cli][programs][threemf]") {
    if (!slicer_is_there()) return;
    const TemporaryFolder folder;
    spit(folder / "ball.stl", write_mesh({make_icosphere(15.0, 3)}, MeshFormat::kStl));
    slicer(folder, "--export-3mf -o " + (folder / "p.3mf") + " " + (folder / "ball.stl"));
    const ProgramResult run =
        run_program(carve_line({folder / "p.3mf", "-o", folder / "c.3mf", "--objects", "ball.stl"}));
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const std::size_t triangles = read_mesh(std::filesystem::path(folder / "c.3mf")).mesh.triangles.size();
    const std::string info = slicer(folder, "--info " + (folder / "c.3mf"));
    CAPTURE(info);
    CHECK(info.find("number_of_facets = " + std::to_string(triangles) + "\n") != info.npos);
    CHECK(info.find("manifold = yes") != info.npos);
}

/// The values of an attribute, in the order of the root model.
std::vector<std::string> values_of(const std::string& package, const std::string& attribute) {
    const std::string bytes = slurp(package);
    const std::string xml = ZipReader(bytes, package).read(kRoot, 1 << 28);
    std::vector<std::string> values;
    const std::string mark = " " + attribute + "=\"";
    for (std::size_t at = xml.find(mark); at != xml.npos; at = xml.find(mark, at + 1)) {
        const std::size_t begin = at + mark.size();
        values.push_back(xml.substr(begin, xml.find('"', begin) - begin));
    }
    return values;
}

TEST_CASE("cli: painted extruders survive a round trip through PrusaSlicer", "[cli][programs][threemf]") {
    if (!slicer_is_there()) return;
    const TemporaryFolder folder;
    spit(folder / "ball.off", write_mesh({make_icosphere(15.0, 3)}, MeshFormat::kOff));
    // Six clear colours in columns, dark enough to be solid all over but for a few holes.
    Image picture;
    picture.width = picture.height = 96;
    const std::vector<Rgba8> colors = {{120, 0, 0, 255},  {0, 110, 0, 255},   {0, 0, 130, 255},
                                       {110, 90, 0, 255}, {100, 0, 110, 255}, {20, 20, 20, 255}};
    for (std::size_t i = 0; i < 96 * 96; ++i) {
        const bool hole = (i % 96) % 48 < 12 && (i / 96) % 48 < 12;
        picture.pixels.push_back(hole ? Rgba8{255, 255, 255, 255} : colors[(i % 96) / 16]);
    }
    write_image(std::filesystem::path(folder / "columns.png"), picture);
    for (const char* format : {"prusa", "bambu"}) {
        CAPTURE(format);
        const ProgramResult run = run_program({"carve",        folder / "ball.off",
                                               "--exemplar",   folder / "columns.png",
                                               "--width-mm",   "28",
                                               "--preset",     "draft",
                                               "--resolution", "64",
                                               "-D",           "structure.max_iterations=1",
                                               "--paint",      format,
                                               "--extruders",  "5",
                                               "-o",           folder / "painted.3mf",
                                               "--summary",    folder / "out.json"});
        CAPTURE(run.err);
        REQUIRE(run.exit_code == 0);
        const Json report = Json::parse(slurp(folder / "out.json"));
        CHECK(report["paint"]["slicer"] == format);
        CHECK(report["paint"]["extruders"].size() == 5);
        CHECK(run.err.find("extruder 5 prints #") != run.err.npos);
        const bool prusa = std::string(format) == "prusa";
        const std::vector<std::string> written =
            values_of(folder / "painted.3mf", prusa ? "slic3rpe:mmu_segmentation" : "paint_color");
        CHECK(written.size() == report["mesh"]["triangles"]);
        CHECK(std::set<std::string>(written.begin(), written.end()) ==
              std::set<std::string>{"4", "8", "0C", "1C", "2C"});
        if (!prusa) continue;  // PrusaSlicer 2.5 does not read the other one.
        slicer(folder, "--export-3mf -o " + (folder / "back.3mf") + " " + (folder / "painted.3mf"));
        CHECK(values_of(folder / "back.3mf", "slic3rpe:mmu_segmentation") == written);
    }
    const ProgramResult plain = run_program({"carve", folder / "ball.off", "--pattern", "cells", "--paint", "prusa",
                                             "-D", "output.colour=none", "-o", folder / "none.3mf"});
    CHECK(plain.exit_code == 3);
    const ProgramResult stl = run_program({"carve", folder / "ball.off", "--pattern", "cells", "--preset", "draft",
                                           "--paint", "prusa", "-o", folder / "ball.stl"});
    CHECK(stl.exit_code == 0);
    CHECK(stl.err.find("ball.stl is not painted") != std::string::npos);
}

}  // namespace
}  // namespace fretwork::testing
