#include "core/fem/beam_model.h"

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/fem/beam_elements.h"
#include "core/fem/beam_wedge_mesh.h"
#include "core/fem/beam_widths.h"
#include "core/fem/equilibrium_solver.h"
#include "core/fem/sample_loads.h"
#include "core/fem/stiffness_pattern.h"

namespace fretwork {
namespace {

/// Factor that turns a hexahedron's stiffness into that of a strand as wide as the pattern is. Held
/// within bounds: beyond them the geometry, not the factor, is wrong.
double width_factor(double pattern_mm, double beam_mm) {
    return std::clamp(pattern_mm / beam_mm, 0.1, 10.0);
}

/// Load cases with the same supports: one matrix, one column of loads each.
struct Supports {
    StiffnessPattern pattern;
    std::optional<EquilibriumSolver> solver;
    Eigen::MatrixXd loads_n;
    std::vector<double> values;

    Supports(const ElementNodes& elements, std::vector<std::uint8_t> fixed_nodes, std::size_t cases)
        : pattern(elements, std::move(fixed_nodes)), values(pattern.entries()) {
        loads_n.setZero(static_cast<Eigen::Index>(pattern.rows()), static_cast<Eigen::Index>(cases));
    }
};

}  // namespace

struct BeamModel::Impl {
    const AbstractGraph& graph;
    BeamModelSettings settings;
    BeamWedgeMesh mesh;
    std::optional<BeamElements> elements;
    BeamWidths widths;
    std::vector<double> width_factors;  ///< per edge
    std::vector<std::unique_ptr<Supports>> supports;

    Impl(const AbstractGraph& graph_in, const BeamModelSettings& settings_in)
        : graph(graph_in), settings(settings_in) {}

    void build_geometry(const SurfaceVoxels& shell, const SolidStates& solid, std::vector<float> half_width_voxels);
    void add_loads(const std::vector<SampleLoads>& cases);
    [[nodiscard]] std::vector<std::uint8_t> fixed_nodes(const SampleLoads& loads) const;
    void smooth_slivers(std::span<const EdgeState> states, std::vector<double>& scores_pa) const;
    void take_scores(const Supports& group, const Eigen::MatrixXd& u, std::span<const EdgeState> states,
                     std::vector<double>& scores_pa) const;
};

void BeamModel::Impl::build_geometry(const SurfaceVoxels& shell, const SolidStates& solid,
                                     std::vector<float> half_width_voxels) {
    widths = beam_widths(shell, solid, graph, std::move(half_width_voxels), settings.bridge_half_width_voxels);
    BeamGeometry geometry;
    geometry.thickness_mm = settings.thickness_mm;
    mesh = build_beam_wedge_mesh(shell, graph, widths.at_sample_voxels, geometry);
    add_ties(sheet_ties(shell, solid, graph, settings.facing), mesh);
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e)
        width_factors.push_back(width_factor(widths.along_edge_mm[e], mesh.beams[e].width_mm));
}

std::vector<std::uint8_t> BeamModel::Impl::fixed_nodes(const SampleLoads& loads) const {
    std::vector<std::uint8_t> fixed(mesh.nodes_mm.size(), 0);
    for (std::size_t s = 0; s < mesh.samples(); ++s)
        if (loads.fixed[s] != 0)
            std::fill(fixed.begin() + mesh.first_node[s], fixed.begin() + mesh.first_node[s + 1], std::uint8_t{1});
    return fixed;
}

void BeamModel::Impl::add_loads(const std::vector<SampleLoads>& cases) {
    std::vector<std::vector<std::size_t>> by_supports;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        const auto same = std::ranges::find_if(
            by_supports, [&](const auto& group) { return cases[group[0]].fixed == cases[c].fixed; });
        if (same == by_supports.end())
            by_supports.push_back({c});
        else
            same->push_back(c);
    }
    for (const std::vector<std::size_t>& members : by_supports) {
        supports.push_back(
            std::make_unique<Supports>(elements->nodes(), fixed_nodes(cases[members.front()]), members.size()));
        Supports& group = *supports.back();
        for (std::size_t column = 0; column < members.size(); ++column) {
            for (std::size_t s = 0; s < mesh.samples(); ++s) {
                // The two nodes in the middle of the fan, below and above, share the sample's force.
                for (const NodeIndex node : {mesh.first_node[s], mesh.first_node[s] + 1}) {
                    const std::int64_t dof = group.pattern.dof(node);
                    if (dof == StiffnessPattern::kFixed) continue;
                    group.loads_n.block<3, 1>(dof, static_cast<Eigen::Index>(column)) +=
                        0.5 * cases[members[column]].force_n[s];
                }
            }
        }
    }
}

BeamModel::BeamModel(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                     std::vector<float> half_width_voxels, const ForceProfile& profile, const Material& material,
                     const BeamModelSettings& settings, const RunControl& run)
    : impl_(std::make_unique<Impl>(graph, settings)) {
    impl_->build_geometry(shell, solid, std::move(half_width_voxels));
    run.throw_if_stopped();
    impl_->elements.emplace(impl_->mesh, material, settings.thickness_mm);
    run.throw_if_stopped();
    std::vector<SampleLoads> cases;
    for (const LoadCase& load_case : profile.cases)
        cases.push_back(loads_on_samples(shell, solid, graph, load_case, material, settings.thickness_mm));
    impl_->add_loads(cases);
    for (const auto& group : impl_->supports) {
        run.throw_if_stopped();
        group->solver.emplace(group->pattern);
    }
}

BeamModel::~BeamModel() = default;
BeamModel::BeamModel(BeamModel&&) noexcept = default;
BeamModel& BeamModel::operator=(BeamModel&&) noexcept = default;

void BeamModel::Impl::take_scores(const Supports& group, const Eigen::MatrixXd& u, std::span<const EdgeState> states,
                                  std::vector<double>& scores_pa) const {
    std::vector<double> of_case(scores_pa.size());
    for (Eigen::Index column = 0; column < u.cols(); ++column) {
        parallel_for(mesh.beams.size(), 64, [&](std::size_t e) {
            Eigen::Matrix<double, 24, 1> moved = Eigen::Matrix<double, 24, 1>::Zero();
            for (int n = 0; n < 8; ++n) {
                const std::int64_t dof = group.pattern.dof(mesh.beams[e].nodes[static_cast<std::size_t>(n)]);
                if (dof != StiffnessPattern::kFixed) moved.segment<3>(3 * n) = u.block<3, 1>(dof, column);
            }
            of_case[e] = 1e6 * elements->beam_score_mpa(e, moved);
        });
        smooth_slivers(states, of_case);
        for (std::size_t e = 0; e < scores_pa.size(); ++e) scores_pa[e] = std::max(scores_pa[e], of_case[e]);
    }
}

void BeamModel::Impl::smooth_slivers(std::span<const EdgeState> states, std::vector<double>& scores_pa) const {
    std::vector<double> weighted(graph.samples.size(), 0.0);
    std::vector<double> weight(graph.samples.size(), 0.0);
    for (EdgeIndex e = 0; e < states.size(); ++e) {
        if (states[e] == EdgeState::kEmpty || widths.is_sliver[e] != 0) continue;
        for (const SampleIndex s : {graph.edges[e].a, graph.edges[e].b}) {
            weighted[s] += scores_pa[e] * widths.along_edge_mm[e];
            weight[s] += widths.along_edge_mm[e];
        }
    }
    for (EdgeIndex e = 0; e < states.size(); ++e) {
        const SampleIndex a = graph.edges[e].a;
        const SampleIndex b = graph.edges[e].b;
        if (widths.is_sliver[e] != 0 && weight[a] + weight[b] > 0.0)
            scores_pa[e] = (weighted[a] + weighted[b]) / (weight[a] + weight[b]);
    }
}

std::vector<double> BeamModel::edge_scores_pa(std::span<const EdgeState> states, const RunControl& run) {
    std::vector<double> factors(states.size());
    for (std::size_t e = 0; e < states.size(); ++e)
        factors[e] = impl_->width_factors[e] * (states[e] == EdgeState::kSolid ? 1.0 : impl_->settings.soft_factor);
    std::vector<double> scores_pa(states.size(), 0.0);
    for (const auto& group : impl_->supports) {
        run.throw_if_stopped();
        impl_->elements->assemble(group->pattern, factors, group->values);
        group->solver->factorize(group->values);
        run.throw_if_stopped();
        impl_->take_scores(*group, group->solver->solve(group->loads_n), states, scores_pa);
    }
    return scores_pa;
}

const std::vector<float>& BeamModel::half_width_voxels() const {
    return impl_->widths.half_width_voxels;
}

double BeamModel::width_mm(EdgeIndex e) const {
    return impl_->widths.along_edge_mm[e];
}

void BeamModel::widen(EdgeIndex e, double least_mm) {
    double& width_mm = impl_->widths.along_edge_mm[e];
    width_mm = std::max(width_mm, least_mm);
    impl_->width_factors[e] = width_factor(width_mm, impl_->mesh.beams[e].width_mm);
}

std::size_t BeamModel::degrees_of_freedom() const {
    std::size_t largest = 0;
    for (const auto& group : impl_->supports) largest = std::max(largest, group->pattern.rows());
    return largest;
}

std::size_t BeamModel::folded_beams() const {
    return impl_->mesh.folded_beams;
}

}  // namespace fretwork
