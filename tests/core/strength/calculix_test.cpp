// An independent program of finite elements agrees with us, voxel by voxel.
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/strength/strength.h"
#include "core/strength/voxel_stress.h"
#include "properties/carve_cases.h"
#include "strength_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;
namespace fs = std::filesystem;

struct ForeignResult {
    std::vector<Vec3> displacement_mm;  ///< per node
    std::vector<Stress> stress_mpa;     ///< per voxel, mean of its integration points
};

/// Units: mm, N, MPa, tonnes.
std::string deck_of(const VoxelModel& model, const VoxelCase& load_case, const Material& material) {
    std::ostringstream deck;
    deck.precision(12);  // fields hold 20 characters
    deck << "*NODE, NSET=NALL\n";
    for (NodeIndex n = 0; n < model.nodes.size(); ++n) {
        const Vec3 at = model.node_mm(n);
        deck << n + 1 << ", " << at[0] << ", " << at[1] << ", " << at[2] << "\n";
    }
    deck << "*ELEMENT, TYPE=C3D8I, ELSET=EALL\n";
    for (std::size_t v = 0; v < model.voxels.size(); ++v) {
        deck << v + 1;
        for (const NodeIndex n : model.corners[v]) deck << ", " << n + 1;
        deck << "\n";
    }
    deck << "*MATERIAL, NAME=M\n*ELASTIC\n" << material.youngs_modulus_mpa << ", " << material.poissons_ratio << "\n";
    deck << "*DENSITY\n"
         << material.density_kg_m3 * 1e-12 << "\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n*NSET, NSET=FIX\n";
    std::vector<std::uint8_t> fixed(model.nodes.size(), 0);
    for (std::size_t v = 0; v < model.voxels.size(); ++v)
        if (load_case.held[v] != 0)
            for (const NodeIndex n : model.corners[v]) fixed[n] = 1;
    for (NodeIndex n = 0; n < fixed.size(); ++n)
        if (fixed[n] != 0) deck << n + 1 << "\n";
    const Vec3 g = load_case.acceleration_g;
    deck << "*BOUNDARY\nFIX,1,3\n*STEP\n*STATIC, SOLVER=SPOOLES\n";
    if (g.norm() > 0.0)
        deck << "*DLOAD\nEALL,GRAV," << 9810.0 * g.norm() << "," << g[0] / g.norm() << "," << g[1] / g.norm() << ","
             << g[2] / g.norm() << "\n";
    if (!load_case.push_n.empty()) {
        deck << "*CLOAD\n";
        for (std::size_t i = 0; i < load_case.push_n.size(); ++i)
            if (load_case.push_n[i] != 0.0)
                deck << i / 3 + 1 << ", " << i % 3 + 1 << ", " << load_case.push_n[i] << "\n";
    }
    deck << "*NODE PRINT, NSET=NALL\nU\n*EL PRINT, ELSET=EALL\nS\n*END STEP\n";
    return deck.str();
}

ForeignResult read_dat(const fs::path& path, const VoxelModel& model) {
    ForeignResult result;
    result.displacement_mm.assign(model.nodes.size(), Vec3::Zero());
    result.stress_mpa.assign(model.voxels.size(), Stress::Zero());
    std::ifstream file(path);
    enum class Block { kNone, kDisplacements, kStresses } block = Block::kNone;
    for (std::string line; std::getline(file, line);) {
        if (line.find("displacements") != line.npos) block = Block::kDisplacements;
        if (line.find("stresses") != line.npos) block = Block::kStresses;
        std::istringstream numbers(line);
        std::size_t id = 0, point = 0;
        if (!(numbers >> id)) continue;
        if (block == Block::kDisplacements) {
            Vec3& u = result.displacement_mm.at(id - 1);
            numbers >> u[0] >> u[1] >> u[2];
        } else if (block == Block::kStresses) {
            // xx yy zz xy xz yz, where ours are xx yy zz xy yz xz.
            std::array<double, 6> s{};
            numbers >> point >> s[0] >> s[1] >> s[2] >> s[3] >> s[5] >> s[4];
            result.stress_mpa.at(id - 1) += 0.125 * Eigen::Map<const Stress>(s.data());
        }
    }
    return result;
}

ForeignResult run_calculix(const VoxelModel& model, const VoxelCase& load_case, const Material& material) {
    const fs::path folder = fs::temp_directory_path() / ("fretwork_ccx_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "job.inp") << deck_of(model, load_case, material);
    const std::string command = "cd " + folder.string() + " && timeout 300 ccx job > job.log 2>&1";
    CHECK(std::system(command.c_str()) == 0);
    ForeignResult result = read_dat(folder / "job.dat", model);
    fs::remove_all(folder);
    return result;
}

bool has_calculix() {
    if (std::system("command -v ccx > /dev/null 2>&1") == 0) return true;
    WARN("ccx (CalculiX) is not installed: skipped");
    return false;
}

void compare(const VoxelModel& model, const VoxelCase& load_case, const Material& material) {
    CAPTURE(model.voxels.size(), load_case.name);
    StrengthSettings settings = settings_with(material);
    settings.solver = SolveBy::kMultigrid;
    settings.tolerance = 1e-9;
    const StrengthReport report = analyze_strength(model, {load_case}, settings);
    const StrengthCase& ours = report.cases[0];
    const ForeignResult theirs = run_calculix(model, load_case, material);
    double most = 0.0, most_apart = 0.0;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        most = std::max(most, theirs.displacement_mm[n].norm());
        most_apart = std::max(most_apart, (theirs.displacement_mm[n] - ours.displacement_mm[n]).norm());
    }
    CHECK(most > 0.0);
    CHECK(most_apart < 1e-5 * most);
    std::vector<float> sums;
    for (const Stress& s : theirs.stress_mpa) sums.push_back(static_cast<float>(1e6 * principal_stress_sum(s)));
    const StressStatistics expected = statistics_of(std::move(sums));
    CHECK(ours.stress_sum.average_pa == Approx(expected.average_pa).epsilon(1e-5));
    CHECK(ours.stress_sum.median_pa == Approx(expected.median_pa).epsilon(1e-5));
    CHECK(ours.stress_sum.p99_pa == Approx(expected.p99_pa).epsilon(1e-5));
    CHECK(ours.stress_sum.max_pa == Approx(expected.max_pa).epsilon(1e-5));
}

TEST_CASE("strength: CalculiX finds the same on a ball of strands", "[strength][programs]") {
    if (!has_calculix()) return;
    const VoxelModel model = carved_ball(64, 1.5);
    REQUIRE(model.voxels.size() > 10000);
    REQUIRE(model.voxels.size() < 40000);
    compare(model, self_weight_cases(model)[0], rubbery(2000.0, 0.35));
}

TEST_CASE("strength: CalculiX finds the same on a carved object", "[strength][programs]") {
    if (!has_calculix()) return;
    for (const PropertyModel& object : property_models()) {
        if (object.open || object.parts != 1 || object.name != "vase") continue;
        const CarveResult carved = carve_model(object, "cells", 1);
        const TriangleMesh& mesh = carved.carved.mesh;
        // Finer voxels until there are enough of them.
        double voxel_mm = 2.0;
        VoxelModel model = make_voxel_model(mesh, voxel_mm);
        while (model.voxels.size() < 12000) model = make_voxel_model(mesh, voxel_mm *= 0.9);
        REQUIRE(model.voxels.size() < 40000);
        VoxelCase pushed = self_weight_cases(model)[1];
        pushed.push_n.resize(3 * model.nodes.size());
        std::ranges::fill(pushed.push_n, 0.0);
        for (NodeIndex n = 0; n < model.nodes.size(); ++n)
            if (model.nodes[n][2] == model.grid.extent[2]) pushed.push_n[3 * std::size_t{n}] = 0.01;
        compare(model, pushed, rubbery(3300.0, 0.36));
        return;
    }
    FAIL("there is no vase among the models");
}

}  // namespace
}  // namespace fretwork
