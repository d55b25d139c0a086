#include "core/fem/free_body.h"

#include <Spectra/SymEigsSolver.h>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/vec.h"

namespace fretwork {
namespace {

constexpr int kMostRounds = 100;
constexpr double kSettled = 1e-3;  // residual of a mode, of its eigenvalue

/// M-orthonormal columns, twice over against rounding. Columns that depend on those before become zero.
void orthonormalize(const Eigen::VectorXd& mass, Eigen::MatrixXd& columns) {
    for (Eigen::Index k = 0; k < columns.cols(); ++k) {
        const double before = std::sqrt(columns.col(k).dot(mass.cwiseProduct(columns.col(k))));
        for (int pass = 0; pass < 2; ++pass) {
            const Eigen::VectorXd weighted = mass.cwiseProduct(columns.col(k));
            const Eigen::VectorXd along = columns.leftCols(k).transpose() * weighted;
            columns.col(k) -= columns.leftCols(k) * along;
        }
        const double norm = std::sqrt(columns.col(k).dot(mass.cwiseProduct(columns.col(k))));
        columns.col(k) *= norm > 1e-12 * before ? 1.0 / norm : 0.0;
    }
}

Eigen::VectorXd per_freedom(const std::vector<double>& per_node) {
    Eigen::VectorXd result(3 * static_cast<Eigen::Index>(per_node.size()));
    for (Eigen::Index i = 0; i < result.size(); ++i) result[i] = per_node[static_cast<std::size_t>(i / 3)];
    return result;
}

/// Nodes that hang together by elements.
std::map<std::uint32_t, std::vector<NodeIndex>> pieces_of(const ElementNodes& elements, std::size_t nodes) {
    DisjointSets sets(nodes);
    for (std::size_t e = 0; e < elements.size(); ++e)
        for (const NodeIndex n : elements.of(e)) sets.unite(elements.of(e).front(), n);
    std::map<std::uint32_t, std::vector<NodeIndex>> pieces;
    for (NodeIndex n = 0; n < nodes; ++n) pieces[sets.find(n)].push_back(n);
    return pieces;
}

/// Translations and turns of every piece.
Eigen::MatrixXd rigid_motions_of(const BeamSystem& system, const Eigen::VectorXd& mass) {
    const std::vector<Vec3>& nodes_mm = system.mesh.nodes_mm;
    const auto pieces = pieces_of(system.elements.nodes(), nodes_mm.size());
    Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(mass.size(), 6 * static_cast<Eigen::Index>(pieces.size()));
    Eigen::Index first = 0;
    for (const auto& [name, nodes] : pieces) {
        Vec3 middle = Vec3::Zero();
        for (const NodeIndex n : nodes) middle += nodes_mm[n] / static_cast<double>(nodes.size());
        for (const NodeIndex n : nodes)
            for (int axis = 0; axis < 3; ++axis) {
                const auto row = 3 * static_cast<Eigen::Index>(n);
                motions(row + axis, first + axis) = 1.0;
                motions.block<3, 1>(row, first + 3 + axis) = Vec3::Unit(axis).cross(nodes_mm[n] - middle);
            }
        first += 6;
    }
    orthonormalize(mass, motions);
    return motions;
}

/// y = D P K^-1 P' D x with D = M^(1/2), where P takes rigid motions out: its eigenvalues are 1 / lambda.
class Flexibility {
  public:
    using Scalar = double;

    Flexibility(const FreeBody& body, const RunControl& run)
        : body_(body), run_(run), root_mass_(body.mass().cwiseSqrt()) {}

    [[nodiscard]] Eigen::Index rows() const { return root_mass_.size(); }
    [[nodiscard]] Eigen::Index cols() const { return root_mass_.size(); }

    void perform_op(const double* x, double* y) const {
        run_.throw_if_stopped();
        const Eigen::VectorXd shape =
            without_rigid(root_mass_.cwiseInverse().cwiseProduct(Eigen::Map<const Eigen::VectorXd>(x, rows())));
        // These loads are in balance, since the shape has no rigid part.
        const Eigen::VectorXd moved = without_rigid(body_.displacements(body_.mass().cwiseProduct(shape)));
        Eigen::Map<Eigen::VectorXd>(y, rows()) = root_mass_.cwiseProduct(moved);
    }

  private:
    [[nodiscard]] Eigen::VectorXd without_rigid(const Eigen::VectorXd& shape) const {
        const Eigen::MatrixXd& rigid = body_.rigid_motions();
        return shape - rigid * (rigid.transpose() * body_.mass().cwiseProduct(shape));
    }

    const FreeBody& body_;
    const RunControl& run_;
    Eigen::VectorXd root_mass_;
};

}  // namespace

FreeBody::FreeBody(const BeamSystem& system, std::span<const double> factors, const std::vector<double>& mass,
                   const RunControl& run)
    : mass_(per_freedom(mass)),
      rigid_(rigid_motions_of(system, mass_)),
      pattern_(system.elements.nodes(), std::vector<std::uint8_t>(mass.size(), 0)),
      solver_(pattern_) {
    run.throw_if_stopped();
    std::vector<double> values(pattern_.entries());
    system.elements.assemble(pattern_, factors, values);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> choice(rigid_.transpose());
    for (Eigen::Index k = 0; k < choice.rank(); ++k) {
        // The diagonal comes first in its column; nothing is fixed, so that freedoms are numbered as entries are.
        const auto freedom = static_cast<std::size_t>(choice.colsPermutation().indices()[k]);
        values[static_cast<std::size_t>(pattern_.column_first()[freedom])] *= 2.0;
    }
    solver_.factorize(values);
}

Eigen::MatrixXd FreeBody::displacements(const Eigen::MatrixXd& forces_n) const {
    return solver_.solve(forces_n);
}

Modes lowest_modes(const FreeBody& body, int count, const RunControl& run) {
    Flexibility flexibility(body, run);
    const Eigen::Index there = body.mass().size() - body.rigid_motions().cols();
    const Eigen::Index wanted = std::min<Eigen::Index>(count, there - 1);
    const Eigen::Index carried = std::min<Eigen::Index>(2 * wanted + 1, there);
    Spectra::SymEigsSolver<Flexibility> solver(flexibility, wanted, carried);
    solver.init();
    solver.compute(Spectra::SortRule::LargestAlge, kMostRounds, kSettled);
    Modes modes;
    modes.lambda = solver.eigenvalues().cwiseInverse();
    modes.shape = body.mass().cwiseSqrt().cwiseInverse().asDiagonal() * solver.eigenvectors();
    return modes;
}

}  // namespace fretwork
