#pragma once
// Finds the rotation nearest to a matrix: the rotation of a region.
//
// R = argmax <R, A> over rotations, A = sum m p q^T. With signed singular values s1 >= s2 >= |s3| of A the
// optimum is well determined about body axis i exactly if the sum of the other two, s_j + s_k, is not nearly 0.
// So a flat region (s3 = 0) has one answer, and an inverted one (s3 < 0), too. A line leaves the rotation about itself undetermined, and a
// point the whole rotation; undetermined parts stay as they were.

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace softcell::ppu {

/// The optimum without a previous rotation: undetermined parts are as in the identity. In two dimensions a matrix that determines no
/// rotation gives the identity.
/// @param matrix  of finite numbers
Eigen::Matrix2d nearest_rotation(const Eigen::Matrix2d& matrix);
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix);

/// Turns `rotation` to the optimum for `matrix`, starting from the last step's answer: Newton's method on SO(3), usually two or three
/// iterations. If they do not converge it starts cold by itself.
/// @param matrix    any 3x3 matrix of finite numbers, of any rank, either sign of the determinant, any scale.
/// @param rotation  unit quaternion; in: last step's, which decides what the matrix leaves undetermined. out: unit.
/// @param floor     a matrix whose Frobenius norm is at most this is noise: the rotation stays. 0 for exact
/// zero.
/// @return          the rotation matrix of the new `rotation`.
/// @note  Real is float or double. Deterministic; allocates nothing.
/// @source  [KKB18] for Newton with a warm start; the safeguards are derived beside the code.
template <typename Real>
Eigen::Matrix<Real, 3, 3> update_rotation(const Eigen::Matrix<Real, 3, 3>& matrix,
                                          Eigen::Quaternion<Real>& rotation, Real floor = Real(0));

/// Finds the optimum without starting from `rotation`, which still decides what the matrix leaves undetermined: the largest eigenvector of
/// Davenport's 4x4 matrix, by Jacobi rotations in double precision. Several times slower than update_rotation().
/// @source  [HORN87]
template <typename Real>
Eigen::Matrix<Real, 3, 3> find_rotation(const Eigen::Matrix<Real, 3, 3>& matrix,
                                        Eigen::Quaternion<Real>& rotation, Real floor = Real(0));

}  // namespace softcell::ppu
