#include "ppu/matching/rotation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "softcell/base/assert.h"

namespace softcell::ppu {

namespace {

template <typename Real>
using Matrix3 = Eigen::Matrix<Real, 3, 3>;

/// Everything below works on matrices of Frobenius norm 1.
template <typename Real>
struct Tolerance;
template <>
struct Tolerance<float> {
  static constexpr float kGoodEnough = 1e-5f;  // after the last iteration; above it, start cold
  static constexpr float kResidual = 1e-6f;    // |axial(R^T A)| at which to stop: some roundings of a float
  static constexpr int kIterations = 6;        // usually one or two; more where s_j + s_k is small
};
template <>
struct Tolerance<double> {
  static constexpr double kGoodEnough = 1e-12;
  static constexpr double kResidual = 1e-14;
  static constexpr int kIterations = 12;  // each gains three digits, fewer where s_j + s_k is small
};
constexpr double kRegularisation = 1e-3;  // mu: keeps axes in place that nothing determines
constexpr double kLongestStep = 1.5;      // radians
constexpr double kPastWeight = 1e-6;  // of the previous rotation in a cold start; far below the weight of A

/// Divides by the square of the norm: a float quaternion has unit length only up to some rounding errors, and the matrix would have four
/// times that error.
template <typename Real>
Matrix3<Real> matrix_of(const Eigen::Quaternion<Real>& q) {
  const Real w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const Real two = 2 / (w * w + x * x + y * y + z * z);
  const Real tx = two * x, ty = two * y, tz = two * z;
  Matrix3<Real> r;
  r(0, 0) = 1 - (ty * y + tz * z);
  r(0, 1) = tx * y - tz * w;
  r(0, 2) = tx * z + ty * w;
  r(1, 0) = tx * y + tz * w;
  r(1, 1) = 1 - (tx * x + tz * z);
  r(1, 2) = ty * z - tx * w;
  r(2, 0) = tx * z - ty * w;
  r(2, 1) = ty * z + tx * w;
  r(2, 2) = 1 - (tx * x + ty * y);
  return r;
}

/// q := normalize(q (1, omega / 2)), the rotation by about omega in the body's frame.
template <typename Real>
void turn(Eigen::Quaternion<Real>& q, Real omega_x, Real omega_y, Real omega_z) {
  const Real x = omega_x / 2, y = omega_y / 2, z = omega_z / 2;
  const Real tw = q.w() - q.x() * x - q.y() * y - q.z() * z;
  const Real tx = q.x() + q.w() * x + q.y() * z - q.z() * y;
  const Real ty = q.y() + q.w() * y + q.z() * x - q.x() * z;
  const Real tz = q.z() + q.w() * z + q.x() * y - q.y() * x;
  const Real scale = 1 / std::sqrt(tw * tw + tx * tx + ty * ty + tz * tz);
  q.w() = tw * scale;
  q.x() = tx * scale;
  q.y() = ty * scale;
  q.z() = tz * scale;
}

/// A / |A|, or false if |A| is at most `floor` or too small to divide by. Works in two steps, as the square of the norm of a huge or tiny
/// matrix is not finite, or 0.
template <typename Real>
bool normalise(const Matrix3<Real>& matrix, Real floor, Matrix3<Real>& normalised) {
  Real largest = 0;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::abs(matrix.data()[i]));
  if (!(largest >= std::numeric_limits<Real>::min())) return false;
  Real square = 0;
  for (int i = 0; i < 9; ++i) {
    normalised.data()[i] = matrix.data()[i] / largest;
    square += normalised.data()[i] * normalised.data()[i];
  }
  const Real norm = std::sqrt(square);
  for (int i = 0; i < 9; ++i) normalised.data()[i] /= norm;
  return largest * norm > floor;
}

enum class Outcome { kConverged, kLost };

/// Newton's method on SO(3) for f(omega) = <R exp([omega]x), A>: gradient g = axial(S), negative Hessian
/// H = tr(S) 1 - sym(S), S = R^T A. All critical points of f but the maximum are saddles, so a positive
/// H at g = 0 is the optimum; where H is not positive a step along the gradient is taken instead. H has the
/// eigenvalues s_j + s_k at the optimum; g has no component where they vanish, and mu keeps H invertible
/// there.
template <typename Real>
Outcome refine(const Matrix3<Real>& a, Eigen::Quaternion<Real>& q, Matrix3<Real>& r) {
  constexpr Real kMu = Real(kRegularisation);
  constexpr Real kAccept = Tolerance<Real>::kGoodEnough * Tolerance<Real>::kGoodEnough;
  constexpr Real kStop = Tolerance<Real>::kResidual * Tolerance<Real>::kResidual;
  for (int iteration = 0;; ++iteration) {
    r = matrix_of(q);
    Real s[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) s[i][j] = r(0, i) * a(0, j) + r(1, i) * a(1, j) + r(2, i) * a(2, j);
    const Real gx = s[2][1] - s[1][2], gy = s[0][2] - s[2][0], gz = s[1][0] - s[0][1];
    const Real residual = gx * gx + gy * gy + gz * gz;

    // H = L D L^T.
    const Real trace = s[0][0] + s[1][1] + s[2][2];
    const Real h00 = trace + kMu - s[0][0], h11 = trace + kMu - s[1][1], h22 = trace + kMu - s[2][2];
    const Real h10 = (s[1][0] + s[0][1]) / -2, h20 = (s[2][0] + s[0][2]) / -2, h21 = (s[2][1] + s[1][2]) / -2;
    const Real d0 = h00;
    const Real l10 = h10 / d0, l20 = h20 / d0;
    const Real d1 = h11 - l10 * h10;
    const Real l21 = (h21 - l20 * h10) / d1;
    const Real d2 = h22 - l20 * h20 - l21 * l21 * d1;
    const bool positive = d0 > kMu / 2 && d1 > kMu / 2 && d2 > kMu / 2;

    if (residual <= kStop) return positive ? Outcome::kConverged : Outcome::kLost;
    if (iteration == Tolerance<Real>::kIterations)
      return positive && residual <= kAccept ? Outcome::kConverged : Outcome::kLost;

    Real x, y, z;
    if (positive) {
      const Real uy = gy - l10 * gx, uz = gz - l20 * gx - l21 * uy;
      z = uz / d2;
      y = uy / d1 - l21 * z;
      x = gx / d0 - l10 * y - l20 * z;
    } else {
      const Real step = 1 / (std::abs(trace) + 1);
      x = gx * step, y = gy * step, z = gz * step;
    }
    const Real length = std::sqrt(x * x + y * y + z * z);
    if (length > Real(kLongestStep)) {
      const Real shorter = Real(kLongestStep) / length;
      x *= shorter, y *= shorter, z *= shorter;
    }
    turn(q, x, y, z);
  }
}

/// The eigenvector of a symmetric matrix to its largest eigenvalue, by cyclic Jacobi rotations.
Eigen::Vector4d largest_eigenvector(double (&k)[4][4]) {
  double v[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  for (int sweep = 0; sweep < 12; ++sweep) {  // six or fewer suffice
    double off = 0, all = 0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        all += k[i][j] * k[i][j];
        if (i != j) off += k[i][j] * k[i][j];
      }
    if (off <= 1e-32 * all) break;
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) {
        if (k[p][q] == 0) continue;
        const double theta = (k[q][q] - k[p][p]) / (2 * k[p][q]);
        const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
        const double c = 1 / std::sqrt(t * t + 1), s = t * c;
        for (int i = 0; i < 4; ++i) {
          const double ip = k[i][p], iq = k[i][q];
          k[i][p] = c * ip - s * iq;
          k[i][q] = s * ip + c * iq;
        }
        for (int i = 0; i < 4; ++i) {
          const double pi = k[p][i], qi = k[q][i];
          k[p][i] = c * pi - s * qi;
          k[q][i] = s * pi + c * qi;
          const double vp = v[i][p], vq = v[i][q];
          v[i][p] = c * vp - s * vq;
          v[i][q] = s * vp + c * vq;
        }
      }
    }
  }
  int best = 0;
  for (int i = 1; i < 4; ++i)
    if (k[i][i] > k[best][best]) best = i;
  return {v[0][best], v[1][best], v[2][best], v[3][best]};
}

/// argmax of q^T K q over unit quaternions, K Davenport's matrix of A + kPastWeight R(q before).
template <typename Real>
void start_cold(const Matrix3<Real>& matrix, Eigen::Quaternion<Real>& rotation) {
  const Matrix3<double> past = matrix_of<double>(rotation.template cast<double>());
  double a[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) a[i][j] = static_cast<double>(matrix(i, j)) + kPastWeight * past(i, j);
  const double trace = a[0][0] + a[1][1] + a[2][2];
  const double z[3] = {a[2][1] - a[1][2], a[0][2] - a[2][0], a[1][0] - a[0][1]};
  double k[4][4];
  k[0][0] = trace;
  for (int i = 0; i < 3; ++i) {
    k[0][i + 1] = k[i + 1][0] = z[i];
    for (int j = 0; j < 3; ++j) k[i + 1][j + 1] = a[i][j] + a[j][i] - (i == j ? trace : 0);
  }
  const Eigen::Vector4d q = largest_eigenvector(k);
  const double scale = 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const double along = q[0] * static_cast<double>(rotation.w()) + q[1] * static_cast<double>(rotation.x()) +
                       q[2] * static_cast<double>(rotation.y()) + q[3] * static_cast<double>(rotation.z());
  const double sign = along < 0 ? -scale : scale;  // q and -q are one rotation; stay on the same side
  rotation.w() = static_cast<Real>(sign * q[0]);
  rotation.x() = static_cast<Real>(sign * q[1]);
  rotation.y() = static_cast<Real>(sign * q[2]);
  rotation.z() = static_cast<Real>(sign * q[3]);
}

template <typename Real>
Matrix3<Real> find_from(const Matrix3<Real>& normalised, Eigen::Quaternion<Real>& rotation) {
  start_cold(normalised, rotation);
  Matrix3<Real> r;
  Eigen::Quaternion<Real> polished = rotation;
  if (refine(normalised, polished, r) == Outcome::kLost) return matrix_of(rotation);
  rotation = polished;
  return r;
}

}  // namespace

template <typename Real>
Eigen::Matrix<Real, 3, 3> update_rotation(const Eigen::Matrix<Real, 3, 3>& matrix,
                                          Eigen::Quaternion<Real>& rotation, Real floor) {
  SC_ASSERT(floor >= 0, "a noise floor of {}", floor);
  SC_ASSERT(std::abs(rotation.squaredNorm() - 1) < Real(1e-2), "a rotation of length {}", rotation.norm());
  Matrix3<Real> a;
  if (!normalise(matrix, floor, a)) return matrix_of(rotation);
  Matrix3<Real> r;
  Eigen::Quaternion<Real> warm = rotation;
  if (refine(a, warm, r) == Outcome::kLost) return find_from(a, rotation);
  rotation = warm;
  return r;
}

template <typename Real>
Eigen::Matrix<Real, 3, 3> find_rotation(const Eigen::Matrix<Real, 3, 3>& matrix,
                                        Eigen::Quaternion<Real>& rotation, Real floor) {
  Matrix3<Real> a;
  if (!normalise(matrix, floor, a)) return matrix_of(rotation);
  return find_from(a, rotation);
}

Eigen::Matrix2d nearest_rotation(const Eigen::Matrix2d& matrix) {
  const double cosine = matrix.trace(), sine = matrix(1, 0) - matrix(0, 1);
  const double length = std::sqrt(cosine * cosine + sine * sine);
  if (!(length > 0)) return Eigen::Matrix2d::Identity();
  Eigen::Matrix2d rotation;
  rotation << cosine, -sine, sine, cosine;
  return rotation / length;
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  return find_rotation(matrix, orientation);
}

template Eigen::Matrix<float, 3, 3> update_rotation(const Eigen::Matrix<float, 3, 3>&,
                                                    Eigen::Quaternion<float>&, float);
template Eigen::Matrix<double, 3, 3> update_rotation(const Eigen::Matrix<double, 3, 3>&,
                                                     Eigen::Quaternion<double>&, double);
template Eigen::Matrix<float, 3, 3> find_rotation(const Eigen::Matrix<float, 3, 3>&,
                                                  Eigen::Quaternion<float>&, float);
template Eigen::Matrix<double, 3, 3> find_rotation(const Eigen::Matrix<double, 3, 3>&,
                                                   Eigen::Quaternion<double>&, double);

}  // namespace softcell::ppu
