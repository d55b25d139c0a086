#include "core/fem/beam_model.h"

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/fem/equilibrium_solver.h"
#include "core/fem/sample_loads.h"
#include "core/fem/stiffness_pattern.h"
#include "core/fem/worst_cases.h"

namespace fretwork {
namespace {

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
    BeamSystem system;
    std::vector<std::unique_ptr<Supports>> supports;

    Impl(const AbstractGraph& graph_in, BeamSystem system_in) : graph(graph_in), system(std::move(system_in)) {}

    void add_loads(const std::vector<SampleLoads>& cases);
    [[nodiscard]] std::vector<std::uint8_t> fixed_nodes(const SampleLoads& loads) const;
    void smooth_slivers(std::span<const EdgeState> states, std::vector<double>& scores_pa) const;
    void take_scores(const Supports& group, const Eigen::MatrixXd& u, std::span<const EdgeState> states,
                     std::vector<double>& scores_pa) const;
};

std::vector<std::uint8_t> BeamModel::Impl::fixed_nodes(const SampleLoads& loads) const {
    std::vector<std::uint8_t> fixed(system.mesh.nodes_mm.size(), 0);
    for (std::size_t s = 0; s < system.mesh.samples(); ++s)
        if (loads.fixed[s] != 0)
            std::fill(fixed.begin() + system.mesh.first_node[s], fixed.begin() + system.mesh.first_node[s + 1],
                      std::uint8_t{1});
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
            std::make_unique<Supports>(system.elements.nodes(), fixed_nodes(cases[members.front()]), members.size()));
        Supports& group = *supports.back();
        for (std::size_t column = 0; column < members.size(); ++column) {
            for (std::size_t s = 0; s < system.mesh.samples(); ++s) {
                // The two nodes in the middle of the fan, below and above, share the sample's force.
                for (const NodeIndex node : {system.mesh.first_node[s], system.mesh.first_node[s] + 1}) {
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
    : impl_(std::make_unique<Impl>(
          graph, BeamSystem(shell, solid, graph, std::move(half_width_voxels), material, settings, run))) {
    run.throw_if_stopped();
    std::vector<SampleLoads> cases;
    const auto add = [&](const LoadCase& load_case) {
        cases.push_back(loads_on_samples(shell, solid, graph, load_case, material, settings.thickness_mm));
    };
    for (const LoadCase& load_case : profile.cases) add(load_case);
    if (profile.worst.regions > 0)
        for (const WorstCase& worst : worst_cases(shell, solid, graph, impl_->system, profile.worst, run))
            add(worst.load_case);
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
        parallel_for(system.mesh.beams.size(), 64, [&](std::size_t e) {
            Eigen::Matrix<double, 24, 1> moved = Eigen::Matrix<double, 24, 1>::Zero();
            for (int n = 0; n < 8; ++n) {
                const std::int64_t dof = group.pattern.dof(system.mesh.beams[e].nodes[static_cast<std::size_t>(n)]);
                if (dof != StiffnessPattern::kFixed) moved.segment<3>(3 * n) = u.block<3, 1>(dof, column);
            }
            of_case[e] = 1e6 * system.elements.beam_score_mpa(e, moved);
        });
        smooth_slivers(states, of_case);
        for (std::size_t e = 0; e < scores_pa.size(); ++e) scores_pa[e] = std::max(scores_pa[e], of_case[e]);
    }
}

void BeamModel::Impl::smooth_slivers(std::span<const EdgeState> states, std::vector<double>& scores_pa) const {
    std::vector<double> weighted(graph.samples.size(), 0.0);
    std::vector<double> weight(graph.samples.size(), 0.0);
    for (EdgeIndex e = 0; e < states.size(); ++e) {
        if (states[e] == EdgeState::kEmpty || system.widths.is_sliver[e] != 0) continue;
        for (const SampleIndex s : {graph.edges[e].a, graph.edges[e].b}) {
            weighted[s] += scores_pa[e] * system.widths.along_edge_mm[e];
            weight[s] += system.widths.along_edge_mm[e];
        }
    }
    for (EdgeIndex e = 0; e < states.size(); ++e) {
        const SampleIndex a = graph.edges[e].a;
        const SampleIndex b = graph.edges[e].b;
        if (system.widths.is_sliver[e] != 0 && weight[a] + weight[b] > 0.0)
            scores_pa[e] = (weighted[a] + weighted[b]) / (weight[a] + weight[b]);
    }
}

std::vector<double> BeamModel::edge_scores_pa(std::span<const EdgeState> states, const RunControl& run) {
    const std::vector<double> factors = impl_->system.factors(states);
    std::vector<double> scores_pa(states.size(), 0.0);
    for (const auto& group : impl_->supports) {
        run.throw_if_stopped();
        impl_->system.elements.assemble(group->pattern, factors, group->values);
        group->solver->factorize(group->values);
        run.throw_if_stopped();
        impl_->take_scores(*group, group->solver->solve(group->loads_n), states, scores_pa);
    }
    return scores_pa;
}

const std::vector<float>& BeamModel::half_width_voxels() const {
    return impl_->system.widths.half_width_voxels;
}

double BeamModel::width_mm(EdgeIndex e) const {
    return impl_->system.widths.along_edge_mm[e];
}

void BeamModel::widen(EdgeIndex e, double least_mm) {
    impl_->system.widen(e, least_mm);
}

std::size_t BeamModel::degrees_of_freedom() const {
    std::size_t largest = 0;
    for (const auto& group : impl_->supports) largest = std::max(largest, group->pattern.rows());
    return largest;
}

std::size_t BeamModel::folded_beams() const {
    return impl_->system.mesh.folded_beams;
}

}  // namespace fretwork
