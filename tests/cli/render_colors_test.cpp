// `render --colour`: what the voxel data of a carved 3MF say, as a picture.
#include <algorithm>
#include <catch2/catch.hpp>

#include "cli/run_program.h"
#include "formats/image_file.h"
#include "formats/mesh_file.h"
#include "formats/volumetric_reader.h"
#include "support/make_meshes.h"

namespace fretwork::testing {
namespace {

/// Pixels of one hue: red far above blue, as bridges are drawn.
std::size_t orange(const Image& picture) {
    return static_cast<std::size_t>(
        std::ranges::count_if(picture.pixels, [](const Rgba8& p) { return p[0] > p[2] + 60 && p[0] > p[1] + 40; }));
}

/// Pixels that are no grey.
std::size_t colored(const Image& picture) {
    return static_cast<std::size_t>(std::ranges::count_if(picture.pixels, [](const Rgba8& p) {
        return std::max({p[0], p[1], p[2]}) > std::min({p[0], p[1], p[2]}) + 40;
    }));
}

TEST_CASE("render: stress, bridges, labels and solid of a carved 3MF", "[cli][render]") {
    const TemporaryFolder folder;
    const TriangleMesh vase = make_vase(50.0, 32, 16);
    spit(folder / "vase.off", write_mesh({vase}, MeshFormat::kOff));
    // Dots hang together by bridges alone.
    const ProgramResult carved =
        run_program({"carve", folder / "vase.off", "--pattern", "dots", "--resolution", "48", "--width-mm", "40", "-D",
                     "structure.max_iterations=2", "-D", "structure.samples=100", "-o", folder / "vase.3mf"});
    CAPTURE(carved.err);
    REQUIRE(carved.exit_code == 0);

    const std::string bytes = slurp(folder / "vase.3mf");
    const std::vector<VolumetricObject> objects = read_volumetric_threemf(bytes, "vase.3mf");
    REQUIRE(objects.size() == 1);
    CHECK(objects[0].properties() == std::vector<std::string>{"fw:label", "fw:reinforced", "fw:solid", "fw:stress"});

    std::vector<Image> pictures;
    for (const char* what : {"stress", "bridges", "labels", "solid"}) {
        const ProgramResult drawn =
            run_program({"render", folder / "vase.3mf", "--colour", what, "--size", "160", "-o", folder / "out.png"});
        CAPTURE(what, drawn.err);
        REQUIRE(drawn.exit_code == 0);
        pictures.push_back(read_image(slurp(folder / "out.png"), "out.png"));
    }
    const std::size_t all = pictures[0].pixels.size();
    CHECK(colored(pictures[0]) > all / 20);  // viridis has no grey
    CHECK(orange(pictures[1]) > all / 200);
    CHECK(orange(pictures[1]) < all / 2);
    CHECK(orange(pictures[0]) == 0);
    CHECK(colored(pictures[2]) > all / 20);
    CHECK(colored(pictures[3]) < all / 200);
}

TEST_CASE("render: a colouring that a file cannot give is an error that says what it wants", "[cli][render]") {
    const TemporaryFolder folder;
    const TriangleMesh vase = make_vase(50.0, 32, 16);
    spit(folder / "vase.off", write_mesh({vase}, MeshFormat::kOff));
    const ProgramResult mesh =
        run_program({"render", folder / "vase.off", "--colour", "stress", "-o", folder / "a.png"});
    CHECK(mesh.exit_code == 2);
    CHECK(mesh.err.find("expected a carved 3MF") != std::string::npos);
    spit(folder / "plain.3mf", write_mesh({vase}, MeshFormat::kThreemf));
    const ProgramResult plain =
        run_program({"render", folder / "plain.3mf", "--colour", "labels", "-o", folder / "a.png"});
    CHECK(plain.exit_code == 2);
    CHECK(plain.err.find("voxel data") != std::string::npos);
    CHECK(run_program({"render", folder / "vase.off", "--colour", "rainbow", "-o", folder / "a.png"}).exit_code == 1);
    CHECK(folder.names() == std::vector<std::string>{"plain.3mf", "vase.off"});
}

}  // namespace
}  // namespace fretwork::testing
