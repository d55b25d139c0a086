#include "core/strength/voxel_solver.h"

#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "core/base/detached.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "strength_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

NodeValues<double> random_values(std::size_t count, std::uint64_t seed) {
    NodeValues<double> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = unit_interval(counter_random(seed, RandomStream::kTest, 1, i, 0)) - 0.5;
    return values;
}

/// K x element by element, the obvious way.
NodeValues<double> product(const VoxelModel& model, const CubeElement& cube, const NodeValues<double>& x) {
    NodeValues<double> y(x.size());
    std::ranges::fill(y, 0.0);
    for (const auto& corners : model.corners) {
        Eigen::Matrix<double, 24, 1> local;
        for (std::size_t c = 0; c < 8; ++c)
            for (std::size_t k = 0; k < 3; ++k) local[static_cast<int>(3 * c + k)] = x[3 * std::size_t{corners[c]} + k];
        local = (cube.stiffness * local).eval();
        for (std::size_t c = 0; c < 8; ++c)
            for (std::size_t k = 0; k < 3; ++k)
                y[3 * std::size_t{corners[c]} + k] += local[static_cast<int>(3 * c + k)];
    }
    return y;
}

double largest_difference(const NodeValues<double>& a, const NodeValues<double>& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

double largest(const NodeValues<double>& a) {
    double most = 0.0;
    for (const double value : a) most = std::max(most, std::abs(value));
    return most;
}

std::vector<std::uint8_t> bottom_nodes(const VoxelModel& model, std::int32_t layers) {
    std::vector<std::uint8_t> fixed;
    for (const VoxelCoord& n : model.nodes) fixed.push_back(n[2] <= layers ? 1 : 0);
    return fixed;
}

TEST_CASE("cube element: six motions without energy, and blocks that say the same as the whole", "[strength]") {
    for (const double nu : {0.0, 0.36, 0.45}) {
        CAPTURE(nu);
        const CubeElement cube = cube_element(0.7, rubbery(2000.0, nu));
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(cube.stiffness, Eigen::EigenvaluesOnly);
        const double stiffest = modes.eigenvalues()[23];
        CHECK(std::abs(modes.eigenvalues()[5]) < 1e-12 * stiffest);
        CHECK(modes.eigenvalues()[6] > 1e-3 * stiffest);
        CHECK(cube.volume_mm3 == Approx(0.343));
        // The transform has the norm sqrt(8): equal eigenvalues but for 8.
        double trace = 0.0;
        for (const Eigen::Matrix3d& block : cube.blocks) trace += block.trace();
        CHECK(8.0 * trace == Approx(cube.stiffness.trace()).epsilon(1e-13));
    }
}

TEST_CASE("fine level: multiplies as the elements do", "[strength]") {
    const CubeElement cube = cube_element(0.5, rubbery(2000.0, 0.35));
    for (const VoxelModel& model : {crumbs(13, 1, 0.5), carved_ball(40, 0.5), full_block({1, 1, 1}, 0.5)}) {
        const std::vector<std::uint8_t> free(model.nodes.size(), 0);
        const FineLevel fine(model, cube, free);
        const NodeValues<double> x = random_values(3 * model.nodes.size(), 5);
        NodeValues<double> y(x.size());
        fine.apply_everywhere(x, y);
        const NodeValues<double> expected = product(model, cube, x);
        CHECK(largest_difference(y, expected) < 1e-13 * largest(expected));
    }
}

TEST_CASE("patch test: constant strain gives constant stress and no force but at the faces", "[strength]") {
    const Material material = rubbery(1234.0, 0.31);
    Eigen::Matrix3d gradient;
    gradient << 1, 2, -3, 0.5, -1, 0.7, 2, -0.4, 1.5;
    gradient *= 1e-3;
    const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
    Stress voigt;
    voigt << strain(0, 0), strain(1, 1), strain(2, 2), 2 * strain(0, 1), 2 * strain(1, 2), 2 * strain(0, 2);
    const Stress s = elasticity(material) * voigt;
    Eigen::Matrix3d stress;
    stress << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const double h = 0.4;
        const VoxelModel model = crumbs(8, seed, h);
        const CubeElement cube = cube_element(h, material);
        NodeValues<double> u(3 * model.nodes.size()), force(u.size()), expected(u.size());
        for (NodeIndex n = 0; n < model.nodes.size(); ++n)
            for (int k = 0; k < 3; ++k)
                u[3 * std::size_t{n} + static_cast<std::size_t>(k)] = (gradient * model.node_mm(n))[k];
        FineLevel(model, cube, std::vector<std::uint8_t>(model.nodes.size(), 0)).apply_everywhere(u, force);
        // A quarter of each voxel face's traction on its corners; between two voxels they cancel.
        std::ranges::fill(expected, 0.0);
        double most_wrong_stress = 0.0;
        for (const auto& corners : model.corners) {
            Eigen::Matrix<double, 24, 1> local;
            for (std::size_t c = 0; c < 8; ++c)
                for (std::size_t k = 0; k < 3; ++k) {
                    const double side = (kCornerBits[c] >> k & 1) != 0 ? 1.0 : -1.0;
                    for (std::size_t j = 0; j < 3; ++j)
                        expected[3 * std::size_t{corners[c]} + j] +=
                            0.25 * h * h * side * stress(static_cast<int>(j), static_cast<int>(k));
                    local[static_cast<int>(3 * c + k)] = u[3 * std::size_t{corners[c]} + k];
                }
            most_wrong_stress = std::max(most_wrong_stress, (cube.center_stress * local - s).cwiseAbs().maxCoeff());
        }
        CHECK(largest_difference(force, expected) < 1e-12 * largest(expected));
        CHECK(most_wrong_stress < 1e-12 * s.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("voxel solver: both ways give one answer", "[strength]") {
    const CubeElement cube = cube_element(1.0, rubbery(2000.0, 0.35));
    for (const VoxelModel& model : {carved_ball(36), full_block({9, 8, 17}), crumbs(12, 4)}) {
        std::vector<std::uint8_t> fixed = bottom_nodes(model, 3);
        std::vector<std::uint8_t> is_held(model.pieces, 0);
        for (std::size_t v = 0; v < model.voxels.size(); ++v)
            if (model.voxels[v][2] < 3) is_held[model.piece[v]] = 1;
        for (std::size_t v = 0; v < model.voxels.size(); ++v)
            if (is_held[model.piece[v]] == 0)
                for (const NodeIndex n : model.corners[v]) fixed[n] = 1;
        std::vector<NodeValues<double>> loads;
        for (const std::uint64_t seed : {1u, 2u}) loads.push_back(random_values(3 * model.nodes.size(), seed));
        SolverSettings settings{SolveBy::kFactor, 1e-10};
        const std::vector<VoxelSolution> exact = VoxelSolver(model, cube, fixed, settings, {}).solve(loads, {});
        settings.by = SolveBy::kMultigrid;
        const VoxelSolver multigrid(model, cube, fixed, settings, {});
        const std::vector<VoxelSolution> found = multigrid.solve(loads, {});
        for (std::size_t k = 0; k < loads.size(); ++k) {
            CHECK(exact[k].iterations == 0);
            CHECK(found[k].iterations > 0);
            CHECK(found[k].iterations < 60);
            CHECK(largest_difference(found[k].displacement_mm, exact[k].displacement_mm) <
                  1e-8 * largest(exact[k].displacement_mm));
        }
    }
}

TEST_CASE("voxel solver: the tolerance is that of the error in the energy", "[strength]") {
    const VoxelModel model = carved_ball(36);
    const CubeElement cube = cube_element(1.0, rubbery(2000.0, 0.35));
    const std::vector<std::uint8_t> fixed = bottom_nodes(model, 4);
    NodeValues<double> load(3 * model.nodes.size());
    for (std::size_t i = 0; i < load.size(); ++i) load[i] = i % 3 == 2 ? -1.0 : 0.0;
    const FineLevel fine(model, cube, fixed);
    const auto energy = [&](const NodeValues<double>& u) {
        NodeValues<double> Ku(u.size());
        fine.apply(u, Ku);
        double sum = 0.0;
        for (std::size_t i = 0; i < u.size(); ++i) sum += u[i] * Ku[i];
        return sum;
    };
    SolverSettings settings{SolveBy::kFactor};
    const VoxelSolution exact = VoxelSolver(model, cube, fixed, settings, {}).solve({load}, {})[0];
    settings.by = SolveBy::kMultigrid;
    for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
        settings.tolerance = tolerance;
        VoxelSolution found = VoxelSolver(model, cube, fixed, settings, {}).solve({load}, {})[0];
        for (std::size_t i = 0; i < load.size(); ++i) found.displacement_mm[i] -= exact.displacement_mm[i];
        CHECK(std::sqrt(energy(found.displacement_mm) / energy(exact.displacement_mm)) < 2.0 * tolerance);
    }
}

TEST_CASE("voxel solver: the same bits on any number of threads", "[strength]") {
    const VoxelModel model = carved_ball(64);
    const CubeElement cube = cube_element(1.0, rubbery(2000.0, 0.35));
    const std::vector<std::uint8_t> fixed = bottom_nodes(model, 6);
    const std::vector<NodeValues<double>> loads = {random_values(3 * model.nodes.size(), 3)};
    std::vector<NodeValues<double>> results;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        results.push_back(
            VoxelSolver(model, cube, fixed, {SolveBy::kMultigrid}, {}).solve(loads, {})[0].displacement_mm);
    }
    CHECK(results[1] == results[0]);
    CHECK(results[2] == results[0]);
}

TEST_CASE("voxel solver: a factor over the memory is refused before it is made", "[strength]") {
    const VoxelModel model = full_block({12, 12, 12});
    const CubeElement cube = cube_element(1.0, rubbery(2000.0, 0.35));
    SolverSettings settings{SolveBy::kFactor};
    const std::size_t bytes = VoxelSolver(model, cube, bottom_nodes(model, 0), settings, {}).factor_bytes();
    CHECK(bytes > 1'000'000);
    settings.most_factor_bytes = bytes - 1;
    CHECK_THROWS_AS(VoxelSolver(model, cube, bottom_nodes(model, 0), settings, {}), MemoryLimit);
    settings.most_factor_bytes = bytes;
    CHECK_NOTHROW(VoxelSolver(model, cube, bottom_nodes(model, 0), settings, {}));
}

TEST_CASE("voxel solver: something that moves freely is named", "[strength]") {
    const VoxelModel model = full_block({3, 3, 3});
    const CubeElement cube = cube_element(1.0, rubbery(2000.0, 0.35));
    const std::vector<std::uint8_t> free(model.nodes.size(), 0);
    CHECK_THROWS_AS(VoxelSolver(model, cube, free, {SolveBy::kFactor}, {}), SolverFailure);
}

TEST_CASE("voxel solver: stops wherever it is", "[strength]") {
    // A full block makes the factor of the coarse level long: about 2 s without a stop.
    const VoxelModel model = full_block({40, 40, 60});
    const CubeElement cube = cube_element(1.0, rubbery(2000.0, 0.35));
    for (const int delay_ms : {0, 100, 300, 700, 1200}) {
        CAPTURE(delay_ms);
        std::stop_source source;
        std::thread asking([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
            source.request_stop();
        });
        const RunControl run({}, source.get_token());
        const auto work = [&] {
            SolverSettings settings{SolveBy::kMultigrid, 1e-12};
            const VoxelSolver solver(model, cube, bottom_nodes(model, 2), settings, run);
            for (std::uint64_t seed = 0;; ++seed)  // until it is stopped
                (void)solver.solve({random_values(3 * model.nodes.size(), seed)}, run);
        };
        CHECK_THROWS_AS(work(), Cancelled);
        asking.join();
    }
    // A program that ends under a factorisation has to leave by _exit, which a test does not.
    while (detached_work_runs()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

}  // namespace
}  // namespace fretwork
