#include "core/strength/cube_element.h"

#include <bit>

namespace fretwork {
namespace {

/// Row: mode (pattern of signs s, axis), column: corner and axis, both in threes.
Eigen::Matrix<double, 24, 24> sign_patterns() {
    Eigen::Matrix<double, 24, 24> W = Eigen::Matrix<double, 24, 24>::Zero();
    for (std::size_t s = 0; s < 8; ++s)
        for (std::size_t c = 0; c < 8; ++c)
            for (int axis = 0; axis < 3; ++axis)
                W(static_cast<int>(3 * s) + axis, static_cast<int>(3 * c) + axis) =
                    std::popcount(s & kCornerBits[c]) % 2 == 0 ? 1.0 : -1.0;
    return W;
}

}  // namespace

CubeElement cube_element(double edge_mm, const Material& material) {
    Corners<8> corners;
    for (std::size_t c = 0; c < 8; ++c)
        for (std::size_t axis = 0; axis < 3; ++axis)
            corners(static_cast<int>(axis), static_cast<int>(c)) = (kCornerBits[c] >> axis & 1) != 0 ? edge_mm : 0.0;
    const Hex8Matrices hex = hex8_matrices(corners, elasticity(material));
    CubeElement cube;
    cube.stiffness = hex.stiffness;
    cube.volume_mm3 = hex.volume_mm3;
    cube.center_stress.setZero();
    for (const auto& at_point : hex.stress_operator) cube.center_stress += 0.125 * at_point;
    // W W^T = 8, so that K = W^T (W K W^T / 64) W.
    const Eigen::Matrix<double, 24, 24> W = sign_patterns();
    const Eigen::Matrix<double, 24, 24> modes = W * hex.stiffness * W.transpose() / 64.0;
    for (std::size_t p = 0; p < 8; ++p)
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b)
                cube.blocks[p](static_cast<int>(a), static_cast<int>(b)) =
                    modes(static_cast<int>(3 * (p ^ (std::size_t{1} << a)) + a),
                          static_cast<int>(3 * (p ^ (std::size_t{1} << b)) + b));
    return cube;
}

}  // namespace fretwork
