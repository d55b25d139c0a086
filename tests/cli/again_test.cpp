// A carved 3MF holds what it takes to carve it again, byte for byte.
#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cli/run_program.h"
#include "formats/content_hash.h"
#include "formats/image_file.h"
#include "formats/mesh_file.h"
#include "formats/zip_reader.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork::testing {
namespace {

using Json = nlohmann::json;

const std::vector<std::string> kQuick = {
    "--preset", "draft", "--resolution", "32", "-D", "structure.max_iterations=1", "-D", "structure.samples=60"};

std::vector<std::string> carve_line(std::vector<std::string> line) {
    line.insert(line.begin(), "carve");
    line.insert(line.end(), kQuick.begin(), kQuick.end());
    return line;
}

std::string vase_off() {
    return write_mesh({make_vase(50.0, 32, 16)}, MeshFormat::kOff);
}

void check_again(const TemporaryFolder& folder, const std::vector<std::string>& more) {
    const ProgramResult first = run_program(carve_line(more));
    CAPTURE(more, first.err);
    REQUIRE(first.exit_code == 0);
    const ProgramResult again = run_program({"carve", folder / "out.3mf", "--again", "-o", folder / "again.3mf"});
    CAPTURE(again.err);
    REQUIRE(again.exit_code == 0);
    CHECK((slurp(folder / "out.3mf") == slurp(folder / "again.3mf")));
}

TEST_CASE("cli: --again makes the same bytes from the package alone", "[cli][again][determinism]") {
    const TemporaryFolder folder;
    const std::string out = folder / "out.3mf";
    SECTION("a mesh and a built-in pattern") {
        spit(folder / "vase.off", vase_off());
        check_again(folder, {folder / "vase.off", "--pattern", "cells", "-o", out, "--seed", "7", "--size-mm", "40",
                             "--input-unit", "inch", "--threads", "1"});
    }
    SECTION("pictures that are gone") {
        spit(folder / "vase.off", vase_off());
        REQUIRE(
            run_program({"pattern", "show", "waves", "-o", folder / "w.png", "--mask", folder / "m.png"}).exit_code ==
            0);
        const ProgramResult first =
            run_program(carve_line({folder / "vase.off", "--exemplar", folder / "w.png", "--mask", folder / "m.png",
                                    "--width-mm", "24", "-o", out}));
        CAPTURE(first.err);
        REQUIRE(first.exit_code == 0);
        for (const char* name : {"vase.off", "w.png", "m.png"}) std::filesystem::remove(folder / name);
        REQUIRE(run_program({"carve", out, "--again", "-o", folder / "again.3mf"}).exit_code == 0);
        CHECK((slurp(out) == slurp(folder / "again.3mf")));
    }
    SECTION("an OBJ with materials, which show where it is kept") {
        spit(folder / "vase.mtl", "newmtl clay\nKd 0.8 0.4 0.2\n");
        spit(folder / "vase.obj",
             "mtllib vase.mtl\nusemtl clay\n" + write_mesh({make_vase(50.0, 32, 16)}, MeshFormat::kObj));
        spit(folder / "s.toml", "[exemplar]\npattern = \"cells\"\n[[keep]]\nshape = \"lowest\"\nshare = 0.2\n");
        const bool kept = GENERATE(true, false);
        const ProgramResult first =
            run_program(carve_line({folder / "vase.obj", "--pattern", folder / "s.toml", "-o", out, "-D",
                                    kept ? "output.source=true" : "output.source=false"}));
        CAPTURE(kept, first.err);
        REQUIRE(first.exit_code == 0);
        const std::vector<Rgb8> colors = read_mesh(std::filesystem::path(out)).triangle_colors;
        CHECK(std::ranges::count(colors, Rgb8{204, 102, 51}) > 0);
        std::vector<std::string> line = {"carve", out, "--again", "-o", folder / "again.3mf"};
        if (kept)
            for (const char* name : {"vase.obj", "vase.mtl"}) std::filesystem::remove(folder / name);
        else
            line.insert(line.end(), {"--source", folder / "vase.obj", "-d", folder / "again.d"});
        const ProgramResult again = run_program(line);
        CAPTURE(again.err);
        REQUIRE(again.exit_code == 0);
        CHECK((slurp(out) == slurp(folder / "again.3mf")));
        if (kept) return;
        for (const char* name : {"out.3mf", "vase.obj", "vase.mtl"})
            CHECK(slurp(folder / "again.d").find(folder / name) != std::string::npos);
        spit(folder / "vase.mtl", "newmtl clay\nKd 0.8 0.4 0.3\n");
        const ProgramResult other = run_program(line);
        CHECK(other.exit_code == 2);
        CHECK(other.err.find("vase.mtl: found SHA-256") != std::string::npos);
    }
    SECTION("a project with a spec for one object") {
        const std::string box = make_mesh_object(1, make_box(Vec3(0, 0, 0), Vec3(20, 20, 20)), "name=\"lid\"");
        spit(folder / "in.3mf", make_package(make_model(box + make_mesh_object(2, make_icosphere(12.0, 2)),
                                                        "<item objectid=\"1\"/><item objectid=\"2\"/>")));
        spit(folder / "s.toml",
             "[exemplar]\npattern = \"cells\"\n[[object]]\nmatch = \"lid\"\nsynthesis.seed = 3\n"
             "[[keep]]\nshape = \"lowest\"\nshare = 0.1\n");
        check_again(folder, {folder / "in.3mf", "--pattern", folder / "s.toml", "-o", out, "--no-thumbnail"});
    }
}

TEST_CASE("cli: --again takes flags on top", "[cli][again]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    REQUIRE(run_program(carve_line({folder / "vase.off", "--pattern", "cells", "-o", folder / "a.3mf"})).exit_code ==
            0);
    REQUIRE(run_program({"carve", folder / "a.3mf", "--again", "--seed", "2", "-o", folder / "b.3mf"}).exit_code == 0);
    REQUIRE(run_program(carve_line({folder / "vase.off", "--pattern", "cells", "--seed", "2", "-o", folder / "c.3mf"}))
                .exit_code == 0);
    CHECK((slurp(folder / "b.3mf") == slurp(folder / "c.3mf")));
    CHECK((slurp(folder / "b.3mf") != slurp(folder / "a.3mf")));
}

TEST_CASE("cli: without its model the package names it by its hash", "[cli][again][errors]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    const std::string out = folder / "out.3mf", again = folder / "again.3mf";
    REQUIRE(run_program(carve_line({folder / "vase.off", "--pattern", "cells", "--no-source", "-o", out})).exit_code ==
            0);
    const std::string bytes = slurp(out);
    const ZipReader zip(bytes, "out");
    CHECK(!zip.contains("Metadata/fretwork/source.off"));
    const auto record = nlohmann::json::parse(zip.read("Metadata/fretwork/run.json", 1 << 20));
    CHECK(record["model"]["sha256"] == content_hash(vase_off()));
    const ProgramResult lacking = run_program({"carve", out, "--again", "-o", again});
    CHECK(lacking.exit_code == 1);
    CHECK(lacking.err.find(content_hash(vase_off())) != lacking.err.npos);
    spit(folder / "other.off", write_mesh({make_vase(51.0, 32, 16)}, MeshFormat::kOff));
    CHECK(run_program({"carve", out, "--again", "--source", folder / "other.off", "-o", again}).exit_code == 2);
    CHECK(!std::filesystem::exists(again));
    REQUIRE(run_program({"carve", out, "--again", "--source", folder / "vase.off", "-o", again}).exit_code == 0);
    CHECK((slurp(again) == bytes));
    const ProgramResult foreign = run_program({"carve", folder / "vase.off", "--again", "-o", again});
    CHECK(foreign.exit_code == 2);
}

TEST_CASE("cli: a carved 3MF shows a picture of itself", "[cli][threemf]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    REQUIRE(run_program(carve_line({folder / "vase.off", "--pattern", "cells", "-o", folder / "a.3mf"})).exit_code ==
            0);
    const std::string bytes = slurp(folder / "a.3mf");
    const ZipReader zip(bytes, "a");
    const Image picture = read_image(zip.read("Metadata/thumbnail.png", 1 << 22), "thumbnail");
    CHECK(picture.width == 256);
    CHECK(zip.read("_rels/.rels", 1 << 20)
              .find("Target=\"/Metadata/thumbnail.png\" "
                    "Type=\"http://schemas.openxmlformats.org/package/2006/relationships/"
                    "metadata/thumbnail\"") != std::string::npos);
    REQUIRE(
        run_program(carve_line({folder / "vase.off", "--pattern", "cells", "-o", folder / "b.3mf", "--no-thumbnail"}))
            .exit_code == 0);
    const std::string plain = slurp(folder / "b.3mf");
    CHECK(!ZipReader(plain, "b").contains("Metadata/thumbnail.png"));
}

TEST_CASE("content hash: the standard's own example", "[formats]") {
    CHECK(content_hash("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(content_hash("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_CASE("cli: info tells what a carved package holds and how it was made", "[cli][again][info]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    const ProgramResult run =
        run_program(carve_line({folder / "vase.off", "--pattern", "cells", "-o", folder / "out.3mf", "--seed", "7",
                                "-D", "output.paint=prusa", "-D", "output.extruders=3"}));
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const Json info = Json::parse(run_program({"info", folder / "out.3mf", "--json"}).out);
    const Json &carved = info["carved"], &package = info["package"];
    CHECK(carved["model"]["sha256"] == content_hash(slurp(folder / "vase.off")));
    CHECK(carved["model"]["in_package"] == true);
    CHECK(carved["spec"]["changed"]["synthesis"]["seed"] == 7);
    CHECK(carved["spec"]["changed"]["exemplar"]["pattern"] == "cells");
    CHECK(carved["shell"]["resolution"] == 32);
    CHECK(carved["mesh"]["triangles"] == info["mesh"]["triangles"]);
    CHECK(package["voxel_data"][0]["properties"][1]["name"] == "fw:solid");
    CHECK(package["voxel_data"][0]["properties"][1]["voxel_mm"][0].get<double>() ==
          Approx(carved["shell"]["voxel_mm"].get<double>()));
    CHECK(package["thumbnail"] == "Metadata/thumbnail.png");
    CHECK(package["paint"][0]["triangles"] == info["mesh"]["triangles"]);
    std::size_t painted = 0;
    for (const auto& [extruder, triangles] : package["paint"][0]["extruders"].items())
        painted += triangles.get<std::size_t>();
    CHECK(painted == info["mesh"]["triangles"]);
    // A plain package has no such record.
    spit(folder / "plain.3mf", make_project());
    CHECK_FALSE(Json::parse(run_program({"info", folder / "plain.3mf", "--json"}).out).contains("carved"));
}

TEST_CASE("cli: info reads on where the record of a run is damaged or an extension is not known", "[cli][info]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    REQUIRE(run_program(carve_line({folder / "vase.off", "--pattern", "cells", "-o", folder / "out.3mf"})).exit_code ==
            0);
    // The same package with another model in it than was carved.
    const std::string bytes = slurp(folder / "out.3mf");
    const ZipReader zip(bytes, "out.3mf");
    Parts parts;
    for (const ZipReader::Entry& entry : zip.entries())
        parts.emplace_back(entry.name,
                           entry.name == "Metadata/fretwork/source.off" ? "OFF 0 0 0" : zip.read(entry.name, 1 << 26));
    spit(folder / "other.3mf", make_zip(parts));
    const ProgramResult damaged = run_program({"info", folder / "other.3mf", "--json"});
    CHECK(damaged.exit_code == 0);
    CHECK_THAT(Json::parse(damaged.out)["carved"]["damaged"].get<std::string>(),
               Catch::Contains("SHA-256") && Catch::Contains("source.off"));
    spit(folder / "q.3mf", make_package(make_model(make_tetrahedron(1), "<item objectid=\"1\"/>",
                                                   "xmlns:q=\"urn:quartz\" requiredextensions=\"q\"")));
    const ProgramResult unknown = run_program({"info", folder / "q.3mf", "--json"});
    REQUIRE(unknown.exit_code == 0);
    const Json info = Json::parse(unknown.out);
    CHECK(info["package"]["extensions"][0]["required"] == true);
    CHECK(info["package"]["extensions"][0]["understood"] == false);
    CHECK_THAT(info["warnings"][0].get<std::string>(), Catch::Contains("urn:quartz"));
}

}  // namespace
}  // namespace fretwork::testing
