// The coordinate frames of the cart, as types. Millimetres, right-handed; a point knows the frame it is in.
#pragma once

#include <Eigen/Core>

namespace orcart {

struct M {};  ///< mesh, the image space of the CT or MR: DICOM's LPS (x left, y posterior, z superior)
struct T {};  ///< tracker: the position sensor's own axes
struct R {};  ///< reference marker, fixed to the patient
struct S {};  ///< scope marker, on the shaft or on the camera head
struct L {};  ///< second marker of a scope that turns, on whichever of light post and head S is not on
struct C {};  ///< camera: origin at the optical centre, x right, y down, z forward
struct E {
};  ///< where C's z axis leaves the distal window (what crosshair, distances and tip errors belong to)
struct P {};  ///< pointer tip

/// A point in frame A, millimetres.
template <class A>
struct Point {
  Eigen::Vector3d mm = Eigen::Vector3d::Zero();
};

/// A direction in frame A; unit length unless said otherwise.
template <class A>
struct Direction {
  Eigen::Vector3d xyz = Eigen::Vector3d::UnitZ();
};

}  // namespace orcart
