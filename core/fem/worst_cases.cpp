#include "core/fem/worst_cases.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "core/fem/free_body.h"
#include "core/fem/linear_program.h"
#include "core/fem/sample_loads.h"
#include "core/fem/solid_elements.h"

namespace fretwork {
namespace {

constexpr int kModes = 12;
constexpr double kApart = 0.1;       // of the extent, from one weak region to the next
constexpr double kLeastArea = 0.2;   // of the median: smaller places are not pushed
constexpr double kLeastPush = 1e-6;  // of all pushes: less is rounding
constexpr int kMostTurnsOfStress = 20;
constexpr double kRise = 1e-6;  // of the score, that is worth another turn

/// The material that belongs to a sample, and what pressure on it comes to.
struct Patch {
    std::vector<VoxelIndex> voxels;
    double area_mm2 = 0.0;
    Vec3 push = Vec3::Zero();       ///< force per newton of pressure times area
    Vec3 moment_mm = Vec3::Zero();  ///< of that force, where the voxels lie
};

std::vector<Patch> patches_of(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph) {
    std::vector<Patch> patches(graph.samples.size());
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        if (solid[v] != SolidState::kSolid || graph.owner[v] == kNoSample) continue;
        Patch& patch = patches[graph.owner[v]];
        const auto area_mm2 = static_cast<double>(shell.area_mm2[v]);
        const Vec3 push = -area_mm2 * shell.normals[v].cast<double>();
        patch.voxels.push_back(v);
        patch.area_mm2 += area_mm2;
        patch.push += push;
        patch.moment_mm += shell.points_mm[v].cross(push);
    }
    for (Patch& patch : patches)
        if (patch.area_mm2 > 0.0) {
            patch.push /= patch.area_mm2;
            patch.moment_mm /= patch.area_mm2;
        }
    return patches;
}

double least_area_mm2(const std::vector<Patch>& patches) {
    std::vector<double> areas;
    for (const Patch& patch : patches) areas.push_back(patch.area_mm2);
    const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
    std::ranges::nth_element(areas, middle);
    return kLeastArea * *middle;
}

/// Of each piece the sample at which most strands meet.
std::map<SampleIndex, SampleIndex> clamps_of(const AbstractGraph& graph, const std::vector<SampleIndex>& piece) {
    std::vector<int> strands(graph.samples.size(), 0);
    for (const AbstractEdge& edge : graph.edges)
        if (edge.state == EdgeState::kSolid) ++strands[edge.a], ++strands[edge.b];
    std::map<SampleIndex, SampleIndex> clamps;
    for (SampleIndex s = 0; s < piece.size(); ++s) {
        const auto [at, is_new] = clamps.try_emplace(piece[s], s);
        if (!is_new && strands[s] > strands[at->second]) at->second = s;
    }
    return clamps;
}

/// Weights of the six stresses whose sum with them is the score while its directions stay: the sum over principal
/// stresses of sign x direction x direction'. No other stress of that score has a larger sum.
Stress directions_of(const Stress& s) {
    Eigen::Matrix3d tensor;
    tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(tensor);
    Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
    for (int k = 0; k < 3; ++k) {
        const Vec3 direction = principal.eigenvectors().col(k);
        g += (principal.eigenvalues()[k] < 0.0 ? -1.0 : 1.0) * direction * direction.transpose();
    }
    Stress weights;
    weights << g(0, 0), g(1, 1), g(2, 2), 2.0 * g(0, 1), 2.0 * g(1, 2), 2.0 * g(0, 2);
    return weights;
}

/// Pressures on one piece that keep it in balance.
struct BalancedPressures {
    std::vector<SampleIndex> samples;  ///< one per column
    std::vector<double> sign;          ///< per column: 1 pushes, -1 pulls
    std::optional<LinearProgram> program;
};

class Search {
  public:
    Search(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph, const BeamSystem& system,
           const WorstCaseSettings& settings, const RunControl& run)
        : shell_(shell),
          graph_(graph),
          system_(system),
          settings_(settings),
          run_(run),
          patches_(patches_of(shell, solid, graph)),
          piece_(piece_of_samples(graph)),
          clamps_(clamps_of(graph, piece_)),
          body_(system, system.factors(states()), node_mass(), run) {}

    std::vector<WorstCase> cases() {
        std::vector<WorstCase> found;
        for (const WeakEdge& weak : weak_regions())
            if (std::optional<WorstCase> worst = worst_for(weak)) found.push_back(*std::move(worst));
        return found;
    }

  private:
    using Corners24 = Eigen::Matrix<double, 24, 1>;
    struct WeakEdge {
        EdgeIndex edge = 0;
        double weakness = 0.0;
        Corners24 moved = Corners24::Zero();  ///< in the mode that makes it weak
    };

    [[nodiscard]] std::vector<EdgeState> states() const {
        std::vector<EdgeState> result;
        for (const AbstractEdge& edge : graph_.edges) result.push_back(edge.state);
        return result;
    }
    /// A sample's material, by its area.
    [[nodiscard]] std::vector<double> node_mass() const {
        std::vector<double> mass(system_.mesh.nodes_mm.size());
        const double least_mm2 = least_area_mm2(patches_);
        for (SampleIndex s = 0; s < graph_.samples.size(); ++s) {
            const std::uint32_t first = system_.mesh.first_node[s], end = system_.mesh.first_node[s + 1];
            for (std::uint32_t n = first; n < end; ++n)
                mass[n] = std::max(patches_[s].area_mm2, least_mm2) / (end - first);
        }
        return mass;
    }
    [[nodiscard]] bool is_clamp(SampleIndex s) const { return clamps_.at(piece_[s]) == s; }
    [[nodiscard]] Vec3 at_mm(SampleIndex s) const { return shell_.points_mm[graph_.samples[s]]; }
    [[nodiscard]] Vec3 middle_mm(EdgeIndex e) const {
        const std::span<const VoxelIndex> path = graph_.voxel_path(e);
        return shell_.points_mm[path[path.size() / 2]];
    }
    [[nodiscard]] Corners24 moved_corners(EdgeIndex e, const Eigen::MatrixXd& shape, Eigen::Index column) const {
        Corners24 moved;
        for (int n = 0; n < 8; ++n)
            moved.segment<3>(3 * n) = shape.block<3, 1>(
                3 * static_cast<Eigen::Index>(system_.mesh.beams[e].nodes[static_cast<std::size_t>(n)]), column);
        return moved;
    }
    [[nodiscard]] double extent_mm() const;
    [[nodiscard]] std::vector<WeakEdge> weakness_of_edges() const;
    [[nodiscard]] std::vector<WeakEdge> weak_regions() const;
    [[nodiscard]] Eigen::MatrixXd equations(const std::vector<SampleIndex>& samples) const;
    BalancedPressures& pressures_on(SampleIndex piece);
    [[nodiscard]] Eigen::MatrixXd responses(EdgeIndex e, const BalancedPressures& pressures) const;
    [[nodiscard]] LoadCase load_case(EdgeIndex e, const BalancedPressures& pressures, const Eigen::VectorXd& x) const;
    std::optional<WorstCase> worst_for(const WeakEdge& weak);

    const SurfaceVoxels& shell_;
    const AbstractGraph& graph_;
    const BeamSystem& system_;
    const WorstCaseSettings& settings_;
    const RunControl& run_;
    std::vector<Patch> patches_;
    std::vector<SampleIndex> piece_;
    std::map<SampleIndex, SampleIndex> clamps_;  ///< piece -> sample
    FreeBody body_;
    std::map<SampleIndex, BalancedPressures> pressures_;
};

double Search::extent_mm() const {
    Eigen::AlignedBox3d box;
    for (SampleIndex s = 0; s < graph_.samples.size(); ++s) box.extend(at_mm(s));
    return box.sizes().maxCoeff();
}

/// Of each solid edge the mode that it fears most, the weakest edge first.
std::vector<Search::WeakEdge> Search::weakness_of_edges() const {
    const Modes swaying = lowest_modes(body_, kModes, run_);
    std::vector<WeakEdge> edges;
    for (EdgeIndex e = 0; e < graph_.edges.size(); ++e) {
        const AbstractEdge& edge = graph_.edges[e];
        if (edge.state != EdgeState::kSolid || system_.widths.is_sliver[e] != 0 || system_.elements.is_link(e) ||
            is_clamp(edge.a) || is_clamp(edge.b))
            continue;
        WeakEdge& weak = edges.emplace_back();
        weak.edge = e;
        for (Eigen::Index k = 0; k < swaying.lambda.size(); ++k) {
            const Corners24 moved = moved_corners(e, swaying.shape, k) / swaying.lambda[k];
            const double score = system_.elements.beam_score_mpa(e, moved);
            if (score <= weak.weakness) continue;
            weak.weakness = score;
            weak.moved = moved;
        }
    }
    std::ranges::stable_sort(edges, [](const WeakEdge& a, const WeakEdge& b) { return a.weakness > b.weakness; });
    return edges;
}

std::vector<Search::WeakEdge> Search::weak_regions() const {
    const double apart_mm = kApart * extent_mm();
    std::vector<WeakEdge> regions;
    for (const WeakEdge& weak : weakness_of_edges()) {
        if (regions.size() == static_cast<std::size_t>(settings_.regions)) break;
        const bool near = std::ranges::any_of(regions, [&](const WeakEdge& other) {
            return (middle_mm(other.edge) - middle_mm(weak.edge)).norm() < apart_mm;
        });
        if (!near && weak.weakness > 0.0) regions.push_back(weak);
    }
    return regions;
}

/// No force, no moment at the samples, none on the voxels; one newton in all. Lengths in extents.
Eigen::MatrixXd Search::equations(const std::vector<SampleIndex>& samples) const {
    Vec3 middle = Vec3::Zero();
    for (const SampleIndex s : samples) middle += at_mm(s) / static_cast<double>(samples.size());
    const double extent = extent_mm();
    Eigen::MatrixXd rows(10, static_cast<Eigen::Index>(samples.size()));
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const Patch& patch = patches_[samples[k]];
        const auto column = static_cast<Eigen::Index>(k);
        rows.block<3, 1>(0, column) = patch.push;
        rows.block<3, 1>(3, column) = (at_mm(samples[k]) - middle).cross(patch.push) / extent;
        rows.block<3, 1>(6, column) = (patch.moment_mm - middle.cross(patch.push)) / extent;
        rows(9, column) = 1.0;
    }
    return rows;
}

BalancedPressures& Search::pressures_on(SampleIndex piece) {
    const auto [at, is_new] = pressures_.try_emplace(piece);
    BalancedPressures& result = at->second;
    if (!is_new) return result;
    const double least = least_area_mm2(patches_);
    for (SampleIndex s = 0; s < piece_.size(); ++s)
        if (piece_[s] == piece && !is_clamp(s) && patches_[s].area_mm2 > least) result.samples.push_back(s);
    if (result.samples.empty()) return result;
    result.sign.assign(result.samples.size(), 1.0);
    Eigen::MatrixXd rows = equations(result.samples);
    const Eigen::VectorXd one = Eigen::VectorXd::Unit(rows.rows(), rows.rows() - 1);
    result.program.emplace(rows, one);
    if (result.program->feasible()) return result;
    const std::vector<SampleIndex> pushed = result.samples;
    result.samples.insert(result.samples.end(), pushed.begin(), pushed.end());
    result.sign.resize(result.samples.size(), -1.0);
    Eigen::MatrixXd both(rows.rows(), 2 * rows.cols());
    both << rows, -rows;
    both.row(both.rows() - 1).setOnes();
    result.program.emplace(both, one);
    return result;
}

/// Displacements of the beam's corners for a newton on each column, by forces at the corners instead: K is symmetric.
Eigen::MatrixXd Search::responses(EdgeIndex e, const BalancedPressures& pressures) const {
    Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(system_.mesh.nodes_mm.size()), 24);
    for (int n = 0; n < 8; ++n)
        for (int axis = 0; axis < 3; ++axis)
            unit(3 * static_cast<Eigen::Index>(system_.mesh.beams[e].nodes[static_cast<std::size_t>(n)]) + axis,
                 3 * n + axis) = 1.0;
    const Eigen::MatrixXd moved = body_.displacements(unit);
    Eigen::MatrixXd result(24, static_cast<Eigen::Index>(pressures.samples.size()));
    for (std::size_t k = 0; k < pressures.samples.size(); ++k) {
        const SampleIndex s = pressures.samples[k];
        const auto row = 3 * static_cast<Eigen::Index>(system_.mesh.first_node[s]);
        // The two nodes in the middle of the fan share the sample's force.
        const Eigen::MatrixXd mean = 0.5 * (moved.middleRows<3>(row) + moved.middleRows<3>(row + 3));
        result.col(static_cast<Eigen::Index>(k)) = pressures.sign[k] * mean.transpose() * patches_[s].push;
    }
    return result;
}

LoadCase Search::load_case(EdgeIndex e, const BalancedPressures& pressures, const Eigen::VectorXd& x) const {
    LoadCase result;
    result.name = "worst case at " + place_name(middle_mm(e));
    for (std::size_t k = 0; k < pressures.samples.size(); ++k) {
        const double share = x[static_cast<Eigen::Index>(k)];
        const Patch& patch = patches_[pressures.samples[k]];
        if (share > kLeastPush)
            result.loads.push_back(
                {patch.voxels, Vec3::Zero(), pressures.sign[k] * share * settings_.total_n / patch.area_mm2});
    }
    for (const auto& [piece, s] : clamps_)
        result.fixed.insert(result.fixed.end(), patches_[s].voxels.begin(), patches_[s].voxels.end());
    std::ranges::sort(result.fixed);
    return result;
}

std::optional<WorstCase> Search::worst_for(const WeakEdge& weak) {
    run_.throw_if_stopped();
    const EdgeIndex e = weak.edge;
    BalancedPressures& pressures = pressures_on(piece_[graph_.edges[e].a]);
    if (!pressures.program || !pressures.program->feasible()) return std::nullopt;
    const Eigen::MatrixXd moved = responses(e, pressures);
    const auto& operators = system_.elements.stress_operators(e);
    const auto score_of = [&](const Eigen::VectorXd& x) {
        return system_.elements.beam_score_mpa(e, Corners24(moved * x));
    };
    double best = 0.0;
    Eigen::VectorXd worst;
    for (int start = 0; start < 16; ++start) {
        const Eigen::Matrix<double, 6, 24> at_point = operators.middleRows<6>(6 * (start / 2));
        const Eigen::MatrixXd stress = at_point * moved;
        Stress aim = (start % 2 == 0 ? 1.0 : -1.0) * directions_of(at_point * weak.moved);
        double reached = 0.0;
        for (int turn = 0; turn < kMostTurnsOfStress; ++turn) {
            const Eigen::VectorXd x = pressures.program->maximize(stress.transpose() * aim);
            const Stress under = stress * x;
            if (const double score = score_of(x); score > best) {
                best = score;
                worst = x;
            }
            const double score = principal_stress_sum(under);
            if (score <= (1.0 + kRise) * reached) break;
            reached = score;
            aim = directions_of(under);
        }
    }
    if (best <= 0.0) return std::nullopt;
    return WorstCase{load_case(e, pressures, worst), e, 1e6 * settings_.total_n * best};
}

}  // namespace

std::vector<WorstCase> worst_cases(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                                   const BeamSystem& system, const WorstCaseSettings& settings, const RunControl& run) {
    if (graph.samples.empty()) return {};
    return Search(shell, solid, graph, system, settings, run).cases();
}

}  // namespace fretwork
