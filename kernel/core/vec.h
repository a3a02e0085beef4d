// Vectors, rotations and matrices: Eigen's, under the names the kernel uses.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace diatom {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond; // constructor order w, x, y, z; unit, body to world

} // namespace diatom
