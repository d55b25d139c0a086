// Does a model print, and does it hold?
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/run_program.h"
#include "core/pipeline/stress_scale.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

using Json = nlohmann::json;
using testing::ProgramResult;
using testing::run_program;
using testing::spit;
using testing::TemporaryFolder;

TEST_CASE("cli: verify says how a model prints, and --strict what is against it", "[cli]") {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const TriangleMesh& mesh) {
        write_mesh(std::filesystem::path(folder / name), {mesh});
    };
    write("block.stl", testing::make_box(Vec3::Zero(), Vec3(10, 10, 4), {1, 1, 1}));
    const ProgramResult sound = run_program({"verify", folder / "block.stl", "--json", "--strict"});
    CAPTURE(sound.err);
    REQUIRE(sound.exit_code == 0);
    const Json facts = Json::parse(sound.out);
    CHECK(facts["sound"] == true);
    CHECK(facts["printability"]["layers"] == 20);
    CHECK(facts["printability"]["first_layer_contact_mm2"].get<double>() == Approx(100.0));

    write("two.stl", testing::make_boxes_sharing_edge());
    const ProgramResult loose =
        run_program({"verify", "--no-strength", folder / "two.stl", "--strict", "--layer-height", "0.1"});
    CHECK(loose.exit_code == 4);
    CHECK(loose.err.find("fault: 1 loose part") != std::string::npos);
    CHECK(loose.out.find("sound = false") != std::string::npos);
    CHECK(run_program({"verify", "--no-strength", folder / "two.stl"}).exit_code == 0);
    // Objects of a plate lie apart on purpose.
    const std::string cube = testing::make_tetrahedron(1) + testing::make_tetrahedron(2);
    spit(folder / "plate.3mf",
         testing::make_package(testing::make_model(
             cube, "<item objectid=\"1\"/><item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 50 0 0\"/>")));
    const ProgramResult plate = run_program({"verify", "--no-strength", folder / "plate.3mf"});
    CHECK(plate.exit_code == 0);
    CHECK(plate.out.find("loose_parts = 0") != std::string::npos);

    write("blade.stl", testing::make_box(Vec3::Zero(), Vec3(10, 0.3, 4), {1, 1, 1}));
    CHECK(run_program({"verify", "--no-strength", folder / "blade.stl", "--strict"})
              .err.find("a strand is 0.30 mm wide") != std::string::npos);
    CHECK(run_program({"verify", "--no-strength", folder / "blade.stl", "--strict", "--nozzle", "0.25"}).exit_code ==
          0);
    CHECK(run_program({"verify", folder / "block.stl", "--layer-height", "0"}).exit_code == 1);
}

TEST_CASE("cli: verify says whether a model holds, and --strict whether it does not", "[cli]") {
    const TemporaryFolder folder;
    // A post of 4 x 4 x 40 mm: pushed at its top with 20 N it bends with 20 * 36 / (64 / 6) = 67 MPa at its foot.
    write_mesh(std::filesystem::path(folder / "post.stl"), {testing::make_box(Vec3::Zero(), Vec3(4, 4, 40))});
    const std::string loads =
        "[structure]\nmaterial = \"PETG\"\n[[loads]]\nname = \"top\"\nshape = \"box\"\nmin_mm = [-1, -1, 38]\n"
        "max_mm = [5, 5, 41]\nforce_n = [20, 0, 0]\ncase = \"push\"\n";
    spit(folder / "loads.toml", loads);
    const std::vector<std::string> line = {
        "verify", folder / "post.stl", "--spec", folder / "loads.toml", "--resolution", "80", "--json"};
    const ProgramResult found = run_program(line);
    CAPTURE(found.err);
    REQUIRE(found.exit_code == 0);
    const Json strength = Json::parse(found.out)["strength"];
    CHECK(strength["holds"] == false);
    CHECK(strength["voxels"] == 8 * 8 * 80);
    CHECK(strength["cases"][0]["name"] == "push");
    CHECK(strength["cases"][0]["applied_n"][0].get<double>() == Approx(20.0));
    CHECK(strength["cases"][0]["reaction_n"][0].get<double>() == Approx(-20.0));
    // In the middle of the outermost voxels, 1.75 of 2 mm out: 59 MPa across layers that hold 30.
    CHECK(strength["factor_of_safety"].get<double>() > 0.4);
    CHECK(strength["factor_of_safety"].get<double>() < 0.56);
    CHECK(strength["weakest"][0]["at_mm"][2].get<double>() < 6.0);
    CHECK(strength["weakest"][0]["case"] == "push");
    CHECK(found.err.find("fault: breaks under \"push\"") != std::string::npos);

    std::vector<std::string> strict = line;
    strict.push_back("--strict");
    CHECK(run_program(strict).exit_code == 4);
    strict.push_back("--no-strength");
    const ProgramResult without = run_program(strict);
    CHECK(without.exit_code == 0);
    CHECK_FALSE(Json::parse(without.out).contains("strength"));

    // Its own weight is nothing to it, in whichever direction.
    const ProgramResult alone =
        run_program({"verify", folder / "post.stl", "--material", "abs", "--resolution", "40", "--strict", "--json"});
    CAPTURE(alone.err);
    REQUIRE(alone.exit_code == 0);
    const Json own = Json::parse(alone.out)["strength"];
    CHECK(own["cases"].size() == 3);
    CHECK(own["factor_of_safety"].get<double>() > 100.0);
    CHECK(own["weight_n"].get<double>() == Approx(640.0 * 1040e-9 * 9.81));

    CHECK(run_program({"verify", folder / "post.stl", "--material", "cheese"}).exit_code == 1);
    CHECK(run_program({"verify", folder / "post.stl", "--spec", folder / "none.toml"}).exit_code == 2);
    CHECK(run_program({"verify", folder / "post.stl", "--resolution", "4"}).exit_code == 1);
    // An open surface has no inside.
    write_mesh(std::filesystem::path(folder / "open.stl"), {testing::make_open_bowl(10.0, 8, 16)});
    const ProgramResult open = run_program({"verify", folder / "open.stl"});
    CHECK(open.exit_code == 0);
    CHECK(open.err.find("note: whether it holds is not known") != std::string::npos);
}

TEST_CASE("cli: verify writes a model in the colours of its stress", "[cli]") {
    const TemporaryFolder folder;
    write_mesh(std::filesystem::path(folder / "post.stl"), {testing::make_box(Vec3::Zero(), Vec3(4, 4, 40))});
    spit(folder / "loads.toml",
         "[[loads]]\nname = \"top\"\nshape = \"box\"\nmin_mm = [-1, -1, 38]\nmax_mm = [5, 5, 41]\n"
         "force_n = [20, 0, 0]\n");
    const ProgramResult found = run_program({"verify", folder / "post.stl", "--spec", folder / "loads.toml",
                                             "--resolution", "80", "--json", "--stress", folder / "stress.ply"});
    CAPTURE(found.err);
    REQUIRE(found.exit_code == 0);
    const std::vector<double> ends = Json::parse(found.out)["strength"]["stress_scale_mpa"];
    // The lowest tenth is held: above it the outermost voxels bear up to 50 MPa.
    CHECK(ends == std::vector<double>{0.05, 50.0});
    const MeshFile shown = read_mesh(std::filesystem::path(folder / "stress.ply"));
    REQUIRE(shown.triangle_colors.size() == shown.mesh.triangles.size());
    int compared = 0;
    for (std::size_t t = 0; t < shown.mesh.triangles.size(); ++t) {
        Vec3 middle = Vec3::Zero();
        for (const std::uint32_t v : shown.mesh.triangles[t]) middle += shown.mesh.positions_mm[v] / 3.0;
        if (middle[0] > 1e-6 && middle[0] < 4.0 - 1e-6) continue;
        // On the sides that are pulled and pushed: moment over section, in the middle of the outermost voxels.
        const double mpa = 20.0 * (39.0 - middle[2]) * 1.75 / (256.0 / 12.0);
        const Rgb8 expected = stress_color(StressScale{ends[0], ends[1]}.place(mpa));
        for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(shown.triangle_colors[t][k] - expected[k]) <= 8);
        ++compared;
    }
    CHECK(compared == 4);
    CHECK(run_program({"verify", folder / "post.stl", "--stress", folder / "none/stress.ply"}).exit_code == 2);
}

TEST_CASE("cli: verify of a carved package takes the loads that it was carved for", "[cli]") {
    const TemporaryFolder folder;
    write_mesh(std::filesystem::path(folder / "vase.off"), {testing::make_vase(50.0, 32, 16)});
    spit(folder / "spec.toml",
         "[exemplar]\npattern = \"cells\"\n[shell]\nresolution = 40\n[structure]\nmaterial = \"ABS\"\n"
         "max_iterations = 1\nsamples = 60\n[input]\nsize_mm = 60\n[[loads]]\nname = \"lip\"\nshape = \"box\"\n"
         "min_mm = [-40, -40, 55]\nmax_mm = [40, 40, 61]\nforce_n = [0, 5, 0]\ncase = \"tilt\"\n");
    const ProgramResult carved = run_program({"carve", folder / "vase.off", "--pattern", folder / "spec.toml",
                                              "--preset", "draft", "-o", folder / "out.3mf"});
    CAPTURE(carved.err);
    REQUIRE(carved.exit_code == 0);
    const ProgramResult found = run_program({"verify", folder / "out.3mf", "--json", "--resolution", "64"});
    CAPTURE(found.err);
    REQUIRE(found.exit_code == 0);
    const Json strength = Json::parse(found.out)["strength"];
    REQUIRE(strength["cases"].size() == 1);
    CHECK(strength["cases"][0]["name"] == "tilt");
    CHECK(strength["cases"][0]["applied_n"][1].get<double>() == Approx(5.0));
    CHECK(strength["cases"][0]["applied_n"][2].get<double>() == Approx(-strength["weight_n"].get<double>()));
    CHECK(strength["volume_mm3"].get<double>() ==
          Approx(Json::parse(found.out)["mesh"]["volume_mm3"].get<double>()).epsilon(0.1));
    // The same twice, whatever the threads.
    CHECK(run_program({"verify", folder / "out.3mf", "--json", "--resolution", "64", "--threads", "1"}).out ==
          found.out);
}

TEST_CASE("cli: verify knows parts of the model where the carved package keeps it", "[cli]") {
    const TemporaryFolder folder;
    const TriangleMesh vase = testing::make_vase(50.0, 32, 16);
    std::string obj = write_mesh({vase}, MeshFormat::kObj);
    std::size_t half = obj.find("\nf ");
    for (std::size_t t = 0; t < vase.triangles.size() / 2; ++t) half = obj.find("\nf ", half + 1);
    obj.insert(half, "\no rest");
    obj.insert(obj.find("\nf "), "\no foot");
    spit(folder / "vase.obj", obj);
    spit(folder / "spec.toml",
         "[exemplar]\npattern = \"cells\"\n[shell]\nresolution = 32\n[structure]\nmax_iterations = 1\nsamples = 60\n"
         "[[loads]]\nname = \"push\"\nshape = \"named\"\nnames = \"rest\"\nforce_n = [0, 5, 0]\n"
         "[[fixtures]]\nname = \"foot\"\nshape = \"named\"\nnames = \"foot\"\n");
    const auto verified = [&](const char* source) {
        const ProgramResult carved =
            run_program({"carve", folder / "vase.obj", "--pattern", folder / "spec.toml", "--preset", "draft", "-D",
                         std::string("output.source=") + source, "-o", folder / "out.3mf"});
        CAPTURE(carved.err);
        REQUIRE(carved.exit_code == 0);
        return run_program({"verify", folder / "out.3mf", "--json", "--resolution", "48"});
    };
    const ProgramResult with_model = verified("true");
    CAPTURE(with_model.err);
    REQUIRE(with_model.exit_code == 0);
    const Json strength = Json::parse(with_model.out)["strength"];
    REQUIRE(strength["cases"].size() == 1);
    CHECK(strength["cases"][0]["applied_n"][1].get<double>() == Approx(5.0));
    const ProgramResult without_model = verified("false");
    CHECK(without_model.exit_code != 0);
    CHECK_THAT(without_model.err, Catch::Contains("region 'push'"));
}

TEST_CASE("cli: verify judges every object of a plate on its own", "[cli][threemf]") {
    const TemporaryFolder folder;
    // Two posts 60 mm apart; where the loads lie is said in the coordinates of each.
    const TriangleMesh post = testing::make_box(Vec3::Zero(), Vec3(4, 4, 40));
    spit(folder / "posts.3mf",
         testing::make_package(testing::make_model(
             testing::make_mesh_object(1, post, "name=\"firm\"") + testing::make_mesh_object(2, post, "name=\"soft\""),
             "<item objectid=\"1\"/><item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 60 0 0\"/>")));
    spit(folder / "loads.toml",
         "[structure]\nmaterial = \"PLA\"\n[[loads]]\nname = \"top\"\nshape = \"box\"\nmin_mm = [-1, -1, 38]\n"
         "max_mm = [5, 5, 41]\nforce_n = [20, 0, 0]\n[[object]]\nmatch = \"soft\"\nstructure.material = \"PETG\"\n");
    const ProgramResult run =
        run_program({"verify", folder / "posts.3mf", "--spec", folder / "loads.toml", "--resolution", "80", "--json"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const Json strength = Json::parse(run.out)["strength"];
    REQUIRE(strength["objects"].size() == 2);
    const auto factor = [&](std::size_t i) { return strength["objects"][i]["factor_of_safety"].get<double>(); };
    CHECK(strength["objects"][0]["object"] == "\"firm\"");
    CHECK(strength["objects"][0]["cases"][0]["applied_n"][0].get<double>() == Approx(20.0));
    CHECK(strength["objects"][0]["voxels"] == 8 * 8 * 80);
    // The same stress, and 40 or 30 MPa to bear it.
    CHECK(factor(0) == Approx(factor(1) * 40.0 / 30.0).epsilon(0.02));
    CHECK(strength["object"] == "\"soft\"");
    CHECK(strength["factor_of_safety"].get<double>() == factor(1));
    CHECK(run.err.find("fault: \"soft\": breaks under") != run.err.npos);
    CHECK(run.err.find("fault: \"firm\": breaks under") != run.err.npos);
    const ProgramResult colors = run_program({"verify", folder / "posts.3mf", "--spec", folder / "loads.toml",
                                              "--resolution", "40", "--stress", folder / "stress.ply"});
    CHECK(colors.exit_code == 1);
    CHECK(colors.err.find("--stress: 2 objects are judged, expected one") != colors.err.npos);
}

}  // namespace
}  // namespace fretwork
