#include "core/fem/free_body.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/counter_random.h"
#include "core/base/disjoint_sets.h"
#include "core/base/vec.h"

namespace fretwork {
namespace {

constexpr int kMostRounds = 30;
constexpr double kSettled = 1e-3;  // relative change of the eigenvalues

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

Eigen::MatrixXd random_columns(Eigen::Index rows, Eigen::Index columns) {
    Eigen::MatrixXd result(rows, columns);
    for (Eigen::Index k = 0; k < columns; ++k)
        for (Eigen::Index i = 0; i < rows; ++i)
            result(i, k) = unit_interval(counter_random(0, RandomStream::kModes, static_cast<std::uint32_t>(k),
                                                        static_cast<std::uint64_t>(i), 0)) -
                           0.5;
    return result;
}

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
    const Eigen::VectorXd& mass = body.mass();
    const Eigen::MatrixXd& rigid = body.rigid_motions();
    const auto without_rigid = [&](Eigen::MatrixXd& shapes) {
        shapes -= rigid * (rigid.transpose() * (mass.asDiagonal() * shapes));
    };
    const Eigen::Index carried = std::min<Eigen::Index>(2 * count, mass.size() - rigid.cols());
    Eigen::MatrixXd shapes = random_columns(mass.size(), carried);
    without_rigid(shapes);
    orthonormalize(mass, shapes);
    Modes modes;
    Eigen::VectorXd before = Eigen::VectorXd::Zero(carried);
    for (int round = 0; round < kMostRounds; ++round) {
        run.throw_if_stopped();
        // These loads are in balance, since the shapes have no rigid part.
        Eigen::MatrixXd next = body.displacements(mass.asDiagonal() * shapes);
        without_rigid(next);
        const Eigen::MatrixXd flexibility = shapes.transpose() * (mass.asDiagonal() * next);
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> turn(0.5 * (flexibility + flexibility.transpose()));
        const Eigen::VectorXd found = turn.eigenvalues().reverse();
        shapes = next * turn.eigenvectors().rowwise().reverse();
        orthonormalize(mass, shapes);
        const Eigen::Index judged = std::min<Eigen::Index>(count, carried);
        const bool settled =
            ((found - before).head(judged).array().abs() <= kSettled * found.head(judged).array()).all();
        before = found;
        if (settled) break;
    }
    const Eigen::Index kept = std::min<Eigen::Index>(count, carried);
    modes.lambda = before.head(kept).cwiseInverse();
    modes.shape = shapes.leftCols(kept);
    return modes;
}

}  // namespace fretwork
