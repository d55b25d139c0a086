#include "core/fem/worst_cases.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/fem/beam_model.h"
#include "core/fem/free_body.h"
#include "core/fem/linear_program.h"
#include "core/fem/pattern_case.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

BeamSystem system_of(const Case& c) {
    return {c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), material_by_name("PLA"), {}};
}

double score_pa(const Case& c, const LoadCase& load_case, EdgeIndex e) {
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), ForceProfile{{load_case}},
                    material_by_name("PLA"), {});
    return model.edge_scores_pa(states_of(c.graph))[e];
}

std::vector<double> uneven_mass(const BeamSystem& system) {
    std::vector<double> mass;
    for (std::size_t n = 0; n < system.mesh.nodes_mm.size(); ++n)
        mass.push_back(1.0 + 0.5 * std::sin(static_cast<double>(n)));
    return mass;
}

Eigen::MatrixXd dense_stiffness(const BeamSystem& system, const std::vector<double>& factors) {
    const std::size_t nodes = system.mesh.nodes_mm.size();
    const StiffnessPattern pattern(system.elements.nodes(), std::vector<std::uint8_t>(nodes, 0));
    std::vector<double> values(pattern.entries());
    system.elements.assemble(pattern, factors, values);
    const auto rows = static_cast<Eigen::Index>(3 * nodes);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(rows, rows);
    for (Eigen::Index j = 0; j < rows; ++j)
        for (std::int64_t i = pattern.column_first()[static_cast<std::size_t>(j)];
             i < pattern.column_first()[static_cast<std::size_t>(j) + 1]; ++i) {
            const std::int64_t row = pattern.row()[static_cast<std::size_t>(i)];
            K(row, j) = K(j, row) = values[static_cast<std::size_t>(i)];
        }
    return K;
}

TEST_CASE("free body: K u = f for forces in balance, with nothing that holds", "[fem][property]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 40, 3, 60);
    const BeamSystem system = system_of(c);
    const std::vector<double> factors = system.factors(states_of(c.graph));
    const Eigen::MatrixXd K = dense_stiffness(system, factors);
    Eigen::MatrixXd pinch = Eigen::MatrixXd::Zero(K.rows(), 1);
    const NodeIndex a = system.mesh.first_node[5], b = system.mesh.first_node[40];
    const Vec3 way = (system.mesh.nodes_mm[b] - system.mesh.nodes_mm[a]).normalized();
    pinch.block<3, 1>(3 * static_cast<Eigen::Index>(a), 0) = way;
    pinch.block<3, 1>(3 * static_cast<Eigen::Index>(b), 0) = -way;
    const FreeBody body(system, factors, uneven_mass(system));
    CHECK((K * body.displacements(pinch) - pinch).norm() < 1e-6);
    CHECK((K * body.rigid_motions()).norm() < 1e-9 * K.norm() * body.rigid_motions().norm());
    CHECK(body.rigid_motions().cols() == 6);
}

TEST_CASE("modes: those of the dense problem, without the six rigid motions", "[fem][property]") {
    const Case c = blob_case(make_icosphere(20.0, 3), 24, 3, 14);
    const BeamSystem system = system_of(c);
    const std::vector<double> factors = system.factors(states_of(c.graph));
    const FreeBody body(system, factors, uneven_mass(system));
    const Modes found = lowest_modes(body, 6);
    const Eigen::MatrixXd K = dense_stiffness(system, factors);
    const Eigen::MatrixXd M = body.mass().asDiagonal();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(K, M);
    REQUIRE(found.lambda.size() == 6);
    for (Eigen::Index k = 0; k < 6; ++k) {
        CAPTURE(k);
        CHECK(std::abs(dense.eigenvalues()[k]) < 1e-6 * dense.eigenvalues()[6]);
        CHECK(found.lambda[k] == Approx(dense.eigenvalues()[6 + k]).epsilon(0.002));
        CHECK(found.shape.col(k).dot(M * found.shape.col(k)) == Approx(1.0));
    }
    CHECK((body.rigid_motions().transpose() * M * found.shape).norm() < 1e-8);
}

struct Resultant {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double total = 0.0;
};

Resultant resultant_of(const SurfaceVoxels& shell, const LoadCase& load_case) {
    Resultant sum;
    for (const PatchLoad& patch : load_case.loads)
        for (const VoxelIndex v : patch.voxels) {
            const double newton = patch.pressure_mpa * static_cast<double>(shell.area_mm2[v]);
            const Vec3 push = -newton * shell.normals[v].cast<double>();
            sum.force += push;
            sum.moment += shell.points_mm[v].cross(push);
            sum.total += std::abs(newton);
        }
    return sum;
}

/// The beam model has each patch push at its sample.
Vec3 moment_at_samples(const Case& c, const LoadCase& load_case) {
    Vec3 moment = Vec3::Zero();
    for (const PatchLoad& patch : load_case.loads)
        for (const VoxelIndex v : patch.voxels)
            moment -= c.shell.points_mm[c.graph.samples[c.graph.owner[v]]].cross(
                patch.pressure_mpa * static_cast<double>(c.shell.area_mm2[v]) * c.shell.normals[v].cast<double>());
    return moment;
}

TEST_CASE("worst cases: in balance, as strong as asked, and what the beam model finds", "[fem][loads][property]") {
    const bool vase = GENERATE(false, true);
    const Case c = blob_case(vase ? make_cylinder(12.0, 40.0, 48, 12) : make_icosphere(20.0, 4), 48, 4, 150);
    const std::vector<WorstCase> cases = worst_cases(c.shell, c.solid, c.graph, system_of(c), {5, 30.0});
    REQUIRE(cases.size() == 5);
    for (const WorstCase& worst : cases) {
        CAPTURE(worst.load_case.name);
        const Resultant sum = resultant_of(c.shell, worst.load_case);
        CHECK(sum.total == Approx(30.0).epsilon(1e-3));
        CHECK(sum.force.norm() < 1e-3);
        CHECK(sum.moment.norm() < 0.05);
        CHECK(moment_at_samples(c, worst.load_case).norm() < 0.05);
        CHECK(worst.load_case.loads.size() <= 10);
        for (const PatchLoad& patch : worst.load_case.loads) CHECK(patch.pressure_mpa > 0.0);
        CHECK(c.graph.edges[worst.edge].state == EdgeState::kSolid);
        CHECK(score_pa(c, worst.load_case, worst.edge) == Approx(worst.score_pa).epsilon(0.03));
        CHECK(worst.load_case.acceleration_g == Vec3::Zero());
    }
}

TEST_CASE("worst cases: the beam model takes those that its profile asks for", "[fem][loads]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 48, 4, 120);
    const std::vector<WorstCase> cases = worst_cases(c.shell, c.solid, c.graph, system_of(c), {3, 20.0});
    REQUIRE(cases.size() == 3);
    ForceProfile profile;
    profile.worst = {3, 20.0};
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), profile, material_by_name("PLA"),
                    {});
    const std::vector<double> scores = model.edge_scores_pa(states_of(c.graph));
    for (const WorstCase& worst : cases) {
        double of_cases = 0.0;
        for (const WorstCase& other : cases) of_cases = std::max(of_cases, score_pa(c, other.load_case, worst.edge));
        CHECK(scores[worst.edge] == Approx(of_cases).epsilon(1e-6));
    }
}

/// Other pressures in balance, of the same strength: extreme ones, that some direction of pushing makes.
std::vector<LoadCase> random_balanced_loads(const Case& c, const LoadCase& like, double total_n, int count) {
    const auto samples = static_cast<Eigen::Index>(c.graph.samples.size());
    std::vector<PatchLoad> patches(c.graph.samples.size());
    std::vector<double> area(patches.size(), 0.0);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(7, samples);
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) {
        if (c.solid[v] != SolidState::kSolid) continue;
        const SampleIndex s = c.graph.owner[v];
        patches[s].voxels.push_back(v);
        area[s] += static_cast<double>(c.shell.area_mm2[v]);
        const Vec3 push = -static_cast<double>(c.shell.area_mm2[v]) * c.shell.normals[v].cast<double>();
        A.block<3, 1>(0, s) += push;
        A.block<3, 1>(3, s) += c.shell.points_mm[c.graph.samples[s]].cross(push) / 20.0;
    }
    for (Eigen::Index s = 0; s < samples; ++s) A.col(s) /= area[static_cast<std::size_t>(s)];
    A.row(6).setOnes();
    LinearProgram program(A, Eigen::VectorXd::Unit(7, 6));
    REQUIRE(program.feasible());
    std::vector<LoadCase> loads;
    for (int i = 0; i < count; ++i) {
        Eigen::VectorXd aim(samples);
        for (Eigen::Index s = 0; s < samples; ++s)
            aim[s] = unit_interval(counter_random(7, RandomStream::kTest, static_cast<std::uint32_t>(i),
                                                  static_cast<std::uint64_t>(s), 0));
        const Eigen::VectorXd x = program.maximize(aim);
        LoadCase& load = loads.emplace_back();
        load.fixed = like.fixed;
        for (SampleIndex s = 0; s < patches.size(); ++s)
            if (x[s] > 0.0) {
                load.loads.push_back(patches[s]);
                load.loads.back().pressure_mpa = x[s] * total_n / area[s];
            }
    }
    return loads;
}

TEST_CASE("worst cases: no other pressure of that strength is worse for the weak region", "[fem][loads][property]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 48, 5, 150);
    const std::vector<WorstCase> cases = worst_cases(c.shell, c.solid, c.graph, system_of(c), {4, 20.0});
    REQUIRE(cases.size() == 4);
    ForceProfile others{random_balanced_loads(c, cases[0].load_case, 20.0, 40)};
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), others, material_by_name("PLA"), {});
    const std::vector<double> worst_of_others = model.edge_scores_pa(states_of(c.graph));
    for (const WorstCase& worst : cases) {
        CHECK(worst.score_pa >= worst_of_others[worst.edge]);
        CHECK(worst_of_others[worst.edge] > 0.02 * worst.score_pa);
    }
    // And for each region its own case is the worst of all that were found.
    for (const WorstCase& worst : cases)
        for (const WorstCase& other : cases) CHECK(score_pa(c, other.load_case, worst.edge) < 1.01 * worst.score_pa);
}

/// Pushes of a newton in all on each sample's material: force, moment on the voxels and at the samples, and the sum.
Eigen::MatrixXd pushes_on_samples(const Case& c) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(10, static_cast<Eigen::Index>(c.graph.samples.size()));
    std::vector<double> area(c.graph.samples.size(), 0.0);
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) {
        if (c.solid[v] != SolidState::kSolid) continue;
        const SampleIndex s = c.graph.owner[v];
        area[s] += static_cast<double>(c.shell.area_mm2[v]);
        const Vec3 push = -static_cast<double>(c.shell.area_mm2[v]) * c.shell.normals[v].cast<double>();
        rows.block<3, 1>(0, s) += push;
        rows.block<3, 1>(3, s) += c.shell.points_mm[c.graph.samples[s]].cross(push) / 40.0;
        rows.block<3, 1>(6, s) += c.shell.points_mm[v].cross(push) / 40.0;
    }
    for (Eigen::Index s = 0; s < rows.cols(); ++s) rows.col(s) /= area[static_cast<std::size_t>(s)];
    rows.row(9).setOnes();
    return rows;
}

TEST_CASE("worst cases: no direction of stress makes a worse one", "[fem][loads][property]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 48, 7, 150);
    const BeamSystem system = system_of(c);
    const std::vector<WorstCase> cases = worst_cases(c.shell, c.solid, c.graph, system, {4, 1.0});
    REQUIRE(cases.size() == 4);
    const Eigen::MatrixXd rows = pushes_on_samples(c);
    Eigen::MatrixXd forces =
        Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(system.mesh.nodes_mm.size()), rows.cols());
    for (Eigen::Index s = 0; s < rows.cols(); ++s)
        for (int node = 0; node < 2; ++node)
            forces.block<3, 1>(
                3 * (static_cast<Eigen::Index>(system.mesh.first_node[static_cast<std::size_t>(s)]) + node), s) =
                0.5 * rows.block<3, 1>(0, s);
    // In balance only together; what a single push does to the springs of the free body adds up to nothing.
    const FreeBody body(system, system.factors(states_of(c.graph)), uneven_mass(system));
    const Eigen::MatrixXd moved = body.displacements(forces);
    LinearProgram program(rows, Eigen::VectorXd::Unit(10, 9));
    REQUIRE(program.feasible());
    for (const WorstCase& worst : cases) {
        Eigen::MatrixXd corners(24, rows.cols());
        for (int n = 0; n < 8; ++n)
            corners.middleRows<3>(3 * n) = moved.middleRows<3>(
                3 * static_cast<Eigen::Index>(system.mesh.beams[worst.edge].nodes[static_cast<std::size_t>(n)]));
        const Eigen::MatrixXd stress = system.elements.stress_operators(worst.edge) * corners;
        double best_mpa = 0.0;
        for (std::uint32_t i = 0; i < 400; ++i) {
            Eigen::VectorXd aim(6);
            for (Eigen::Index k = 0; k < 6; ++k)
                aim[k] =
                    unit_interval(counter_random(3, RandomStream::kTest, i, static_cast<std::uint64_t>(k), 0)) - 0.5;
            const Eigen::VectorXd x = program.maximize(stress.middleRows<6>(6 * (i % 8)).transpose() * aim);
            const Eigen::Matrix<double, 24, 1> at_corners = corners * x;
            best_mpa = std::max(best_mpa, system.elements.beam_score_mpa(worst.edge, at_corners));
        }
        CAPTURE(worst.edge, 1e6 * best_mpa / worst.score_pa);
        // A climb may end a little below the top.
        CHECK(worst.score_pa >= 0.99 * 1e6 * best_mpa);
        CHECK(worst.score_pa < 1.5 * 1e6 * best_mpa);
    }
}

TEST_CASE("worst cases: a narrow neck is where a dumb-bell is weak", "[fem][loads]") {
    // A band around the equator that is empty but for two strands.
    const SurfaceVoxels shell = voxelize(make_icosphere(20.0, 4), {.resolution = 48});
    SolidStates states(shell.size(), SolidState::kSolid);
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        const Vec3& p = shell.points_mm[v];
        if (std::abs(p[2]) < 4.0 && std::abs(p[1]) > 2.0) states[v] = SolidState::kEmpty;
    }
    const Case c = make_case(make_icosphere(20.0, 4), 48, &states, 120);
    const std::vector<WorstCase> cases = worst_cases(c.shell, c.solid, c.graph, system_of(c), {1, 20.0});
    REQUIRE(cases.size() == 1);
    const std::span<const VoxelIndex> path = c.graph.voxel_path(cases[0].edge);
    const Vec3 middle = shell.points_mm[path[path.size() / 2]];
    CHECK(std::abs(middle[2]) < 8.0);
    CHECK(std::abs(middle[1]) < 5.0);
}

TEST_CASE("worst cases: pressure may pull on a sheet", "[fem][loads]") {
    const Case c = make_case(make_square(40.0, 8), 40, nullptr, 60);
    const std::vector<WorstCase> cases = worst_cases(c.shell, c.solid, c.graph, system_of(c), {2, 10.0});
    REQUIRE(cases.size() == 2);
    for (const WorstCase& worst : cases) {
        const Resultant sum = resultant_of(c.shell, worst.load_case);
        CHECK(sum.total == Approx(10.0).epsilon(1e-3));
        CHECK(sum.force.norm() < 1e-3);
    }
}

TEST_CASE("worst cases: the same bits on any number of threads, and an end when asked", "[fem][loads][determinism]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 40, 5, 80);
    std::vector<double> reference;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        std::vector<double> scores;
        for (const WorstCase& worst : worst_cases(c.shell, c.solid, c.graph, system_of(c), {3, 20.0}))
            scores.push_back(worst.score_pa);
        if (threads == 1) reference = scores;
        CHECK(scores == reference);
    }
    CHECK(reference.size() == 3);
    std::stop_source source;
    const RunControl run(nullptr, source.get_token());
    const BeamSystem system = system_of(c);
    source.request_stop();
    CHECK_THROWS_AS(worst_cases(c.shell, c.solid, c.graph, system, {3, 20.0}, run), Cancelled);
}

}  // namespace
}  // namespace fretwork
