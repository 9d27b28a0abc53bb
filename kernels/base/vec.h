// vec.h: small vectors, quaternions and 3x3 matrices for host and device.
// Right-handed frames; a quaternion (w, x, y, z) rotates from the body frame to the world frame.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "kernels/base/config.h"

namespace scree {

template <class T>
struct Vec3T {
  T x{}, y{}, z{};

  SCREE_HD T& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
  SCREE_HD T const& operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
  SCREE_HD Vec3T& operator+=(Vec3T b) { return x += b.x, y += b.y, z += b.z, *this; }
  SCREE_HD Vec3T& operator-=(Vec3T b) { return x -= b.x, y -= b.y, z -= b.z, *this; }
  SCREE_HD Vec3T& operator*=(T s) { return x *= s, y *= s, z *= s, *this; }
  SCREE_HD friend Vec3T operator+(Vec3T a, Vec3T b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  SCREE_HD friend Vec3T operator-(Vec3T a, Vec3T b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  SCREE_HD friend Vec3T operator-(Vec3T a) { return {-a.x, -a.y, -a.z}; }
  SCREE_HD friend Vec3T operator*(Vec3T a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  SCREE_HD friend Vec3T operator*(T s, Vec3T a) { return {a.x * s, a.y * s, a.z * s}; }
  SCREE_HD friend Vec3T operator/(Vec3T a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  SCREE_HD friend bool operator==(Vec3T a, Vec3T b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

using Vec3 = Vec3T<double>;
using Vec3f = Vec3T<float>;

template <class T>
SCREE_HD inline T dot(Vec3T<T> a, Vec3T<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
SCREE_HD inline Vec3T<T> cross(Vec3T<T> a, Vec3T<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
SCREE_HD inline Vec3 multiply(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }  // element by element
SCREE_HD inline Vec3 divide(Vec3 a, Vec3 b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }    // element by element
SCREE_HD inline double norm2(Vec3 a) { return dot(a, a); }
SCREE_HD inline double norm(Vec3 a) { return std::sqrt(dot(a, a)); }
SCREE_HD inline float norm(Vec3f a) { return std::sqrt(dot(a, a)); }
SCREE_HD inline Vec3 normalized(Vec3 a) { return a / norm(a); }
SCREE_HD inline Vec3f to_float(Vec3 a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}
SCREE_HD inline Vec3 to_double(Vec3f a) { return {a.x, a.y, a.z}; }
SCREE_HD inline bool is_finite(Vec3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

struct Mat3 {
  Vec3 row[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  SCREE_HD friend Vec3 operator*(Mat3 const& m, Vec3 v) {
    return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
  }
};
// m^T v, without forming the transpose.
SCREE_HD inline Vec3 transposed_times(Mat3 const& m, Vec3 v) {
  return m.row[0] * v.x + m.row[1] * v.y + m.row[2] * v.z;
}
SCREE_HD inline Mat3 transpose(Mat3 const& m) {
  return {{{m.row[0].x, m.row[1].x, m.row[2].x},
           {m.row[0].y, m.row[1].y, m.row[2].y},
           {m.row[0].z, m.row[1].z, m.row[2].z}}};
}
SCREE_HD inline Mat3 operator*(Mat3 const& a, Mat3 const& b) {
  Mat3 const bt = transpose(b);
  return {{{dot(a.row[0], bt.row[0]), dot(a.row[0], bt.row[1]), dot(a.row[0], bt.row[2])},
           {dot(a.row[1], bt.row[0]), dot(a.row[1], bt.row[1]), dot(a.row[1], bt.row[2])},
           {dot(a.row[2], bt.row[0]), dot(a.row[2], bt.row[1]), dot(a.row[2], bt.row[2])}}};
}

struct Quat {
  double w = 1, x = 0, y = 0, z = 0;

  SCREE_HD friend bool operator==(Quat a, Quat b) { return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z; }
};
SCREE_HD inline Quat operator*(Quat a, Quat b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
SCREE_HD inline Quat normalized(Quat q) {
  double const s = 1 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}
// Rotation by the vector `angle` (axis times angle [rad]).
SCREE_HD inline Quat quat_from_rotation_vector(Vec3 angle) {
  double const a = norm(angle);
  double const s = a > 1e-12 ? std::sin(a / 2) / a : 0.5;
  return {std::cos(a / 2), angle.x * s, angle.y * s, angle.z * s};
}
// Rotation matrix body -> world of a unit quaternion.
SCREE_HD inline Mat3 to_matrix(Quat q) {
  return {{{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y)},
           {2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x)},
           {2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)}}};
}

struct Box {
  Vec3 min, max;
};
// A box that contains nothing, meets nothing and leaves every union as it is. Finite: 0 times infinity is no number.
SCREE_HD inline Box empty_box() { return {{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}}; }
SCREE_HD inline bool is_empty(Box const& b) { return b.min.x > b.max.x; }

}  // namespace scree
