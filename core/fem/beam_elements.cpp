#include "core/fem/beam_elements.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/parallel.h"
#include "core/fem/solid_elements.h"

namespace fretwork {
namespace {

template <std::size_t N>
Corners<static_cast<int>(N)> corners_of(const BeamWedgeMesh& mesh, const std::array<NodeIndex, N>& nodes) {
    Corners<static_cast<int>(N)> corners;
    for (std::size_t n = 0; n < N; ++n) corners.col(static_cast<Eigen::Index>(n)) = mesh.nodes_mm[nodes[n]];
    return corners;
}

/// Mean direction from the bottom to the top at the two ends.
Vec3 up_of(const Corners<8>& c) {
    const Vec3 at_a = c.col(4) + c.col(7) - c.col(0) - c.col(3);
    const Vec3 at_b = c.col(5) + c.col(6) - c.col(1) - c.col(2);
    const Vec3 sum = at_a.normalized() + at_b.normalized();
    return sum.norm() > 1e-6 ? Vec3(sum.normalized()) : Vec3(at_a.normalized());
}

}  // namespace

BeamElements::BeamElements(const BeamWedgeMesh& mesh, const Material& material, double thickness_mm) {
    const Elasticity D = elasticity(material);
    for (const Wedge& wedge : mesh.wedges) nodes_.add(wedge.nodes);
    for (const Beam& beam : mesh.beams) nodes_.add(beam.nodes);
    for (const Tie& tie : mesh.ties) nodes_.add(tie.nodes);
    wedge_stiffness_.resize(mesh.wedges.size());
    beam_stiffness_.resize(mesh.beams.size());
    beam_stress_.resize(mesh.beams.size());
    section_.resize(mesh.beams.size());
    is_link_.resize(mesh.beams.size());
    tie_stiffness_.resize(mesh.ties.size());
    parallel_for(mesh.ties.size(), 32, [&](std::size_t t) {
        const Corners<8> corners = corners_of(mesh, mesh.ties[t].nodes);
        const BeamSection section{mesh.ties[t].side_mm, mesh.ties[t].side_mm};
        const Vec3 along = corners.col(1) + corners.col(2) - corners.col(0) - corners.col(3);
        const Vec3 across = along.norm() > 0.0 ? along.unitOrthogonal() : Vec3::UnitZ();
        tie_stiffness_[t] = frame_link_matrices(corners, across, section, material).stiffness;
    });
    parallel_for(mesh.wedges.size(), 64, [&](std::size_t w) {
        wedge_stiffness_[w] = wedge6_matrices(corners_of(mesh, mesh.wedges[w].nodes), D).stiffness;
    });
    parallel_for(mesh.beams.size(), 32, [&](std::size_t e) {
        const Beam& beam = mesh.beams[e];
        const Corners<8> corners = corners_of(mesh, beam.nodes);
        section_[e] = {beam.width_mm, thickness_mm};
        is_link_[e] = beam.folds ? 1 : 0;
        beam_stress_[e].setZero();
        if (beam.folds) {
            const FrameLinkMatrices link = frame_link_matrices(corners, up_of(corners), section_[e], material);
            beam_stiffness_[e] = link.stiffness;
            beam_stress_[e].topRows<6>() = link.end_forces[0];
            beam_stress_[e].middleRows<6>(6) = link.end_forces[1];
        } else {
            const Hex8Matrices hex = hex8_matrices(corners, D);
            beam_stiffness_[e] = hex.stiffness;
            for (int p = 0; p < 8; ++p)
                beam_stress_[e].middleRows<6>(6 * p) = hex.stress_operator[static_cast<std::size_t>(p)];
        }
    });
}

void BeamElements::assemble(const StiffnessPattern& pattern, std::span<const double> beam_factors,
                            std::span<double> values) const {
    std::ranges::fill(values, 0.0);
    for (std::size_t w = 0; w < wedges(); ++w) pattern.add_element(w, 1.0, wedge_stiffness_[w].data(), values);
    for (std::size_t e = 0; e < beams(); ++e)
        pattern.add_element(wedges() + e, beam_factors[e], beam_stiffness_[e].data(), values);
    for (std::size_t t = 0; t < tie_stiffness_.size(); ++t)
        pattern.add_element(wedges() + beams() + t, 1.0, tie_stiffness_[t].data(), values);
}

double BeamElements::beam_score_mpa(std::size_t beam, const Eigen::Matrix<double, 24, 1>& displacements_mm) const {
    const Eigen::Matrix<double, 48, 1> s = beam_stress_[beam] * displacements_mm;
    if (is_link_[beam] != 0)
        return std::max(frame_link_stress_sum(s.head<6>(), section_[beam]),
                        frame_link_stress_sum(s.segment<6>(6), section_[beam]));
    double worst = 0.0;
    for (int p = 0; p < 8; ++p) worst = std::max(worst, principal_stress_sum(s.segment<6>(6 * p)));
    return worst;
}

}  // namespace fretwork
