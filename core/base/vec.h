// Vectors used by every stage.
#pragma once

#include <Eigen/Core>

namespace fretwork {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec2f = Eigen::Vector2f;
using Vec3f = Eigen::Vector3f;

}  // namespace fretwork
