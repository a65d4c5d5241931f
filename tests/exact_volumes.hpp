// Oracle for intersections of frusta, boxes and hulls: separating axes in exact arithmetic.
//
// Shares no code with the library. Numbers are integers times powers of two: every float or double
// is one, and so are all sums and products, so that nothing is rounded. A filter in long double
// answers for pairs that are clearly apart or clearly overlapping; all others go the exact way.
#pragma once

#include <warpshadow/frustum.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace oracle {

/// m 2^e, exact.
class dyadic {
  public:
    dyadic() = default;
    dyadic(double x) {
        int e = 0;
        const double m = std::frexp(x, &e);
        m_ = static_cast<long long>(std::ldexp(m, 53));
        e_ = m_ == 0 ? 0 : e - 53;
    }
    friend dyadic operator*(const dyadic& a, const dyadic& b) {
        return dyadic(a.m_ * b.m_, a.e_ + b.e_);
    }
    friend dyadic operator+(const dyadic& a, const dyadic& b) {
        if (a.m_ == 0) {
            return b;
        }
        if (b.m_ == 0) {
            return a;
        }
        if (a.e_ <= b.e_) {
            return dyadic(a.m_ + (b.m_ << (b.e_ - a.e_)), a.e_);
        }
        return dyadic((a.m_ << (a.e_ - b.e_)) + b.m_, b.e_);
    }
    friend dyadic operator-(const dyadic& a) { return dyadic(-a.m_, a.e_); }
    friend dyadic operator-(const dyadic& a, const dyadic& b) { return a + (-b); }
    friend bool operator<(const dyadic& a, const dyadic& b) { return (a - b).sign() < 0; }
    int sign() const { return m_ < 0 ? -1 : m_ > 0 ? 1 : 0; }

  private:
    dyadic(boost::multiprecision::cpp_int m, int e) : m_(std::move(m)), e_(m_ == 0 ? 0 : e) {}
    boost::multiprecision::cpp_int m_ = 0;
    int e_ = 0;
};

template <typename N> struct vec {
    std::array<N, 3> v;
    N& operator[](std::size_t i) { return v[i]; }
    const N& operator[](std::size_t i) const { return v[i]; }
};

template <typename N> vec<N> operator+(const vec<N>& a, const vec<N>& b) {
    return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}};
}
template <typename N> vec<N> operator-(const vec<N>& a, const vec<N>& b) {
    return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}};
}
template <typename N> vec<N> times(const N& s, const vec<N>& a) {
    return {{s * a[0], s * a[1], s * a[2]}};
}
template <typename N> N dot(const vec<N>& a, const vec<N>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <typename N> vec<N> cross(const vec<N>& a, const vec<N>& b) {
    return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
template <typename N, typename T> vec<N> make(const glm::vec<3, T>& v) {
    return {
        {N(static_cast<double>(v.x)), N(static_cast<double>(v.y)), N(static_cast<double>(v.z))}};
}

/// A convex set: the hull of its points, extended along its directions.
template <typename N> struct body {
    std::vector<vec<N>> points;
    std::vector<vec<N>> directions;
    std::vector<vec<N>> edges;   ///< along all edges, parallel ones once
    std::vector<vec<N>> normals; ///< of all faces, opposite ones once
};

/// The frustum of exactly the numbers in `f`, shifted by -`origin`.
template <typename N, typename T>
body<N> make_body(const warpshadow::frustum<T>& f, const glm::vec<3, T>& origin) {
    const vec<N> eye = make<N>(f.eye) - make<N>(origin);
    const vec<N> right = make<N>(f.right);
    const vec<N> up = make<N>(f.up);
    const vec<N> forward = make<N>(f.forward);
    const auto& v = f.volume;
    const double xs[4] = {double(v.left), double(v.right), double(v.right), double(v.left)};
    const double ys[4] = {double(v.bottom), double(v.bottom), double(v.top), double(v.top)};
    body<N> b;
    vec<N> rays[4];
    for (int i = 0; i < 4; ++i) {
        const vec<N> across = times(N(xs[i]), right) + times(N(ys[i]), up);
        rays[i] = v.orthographic ? forward : across + forward;
        const vec<N> base = v.orthographic ? eye + across : eye;
        b.points.push_back(base + times(N(double(v.near_distance)), rays[i]));
        if (std::isinf(v.far_distance)) {
            b.directions.push_back(rays[i]);
        } else {
            b.points.push_back(base + times(N(double(v.far_distance)), rays[i]));
        }
    }
    b.edges = {right, up, rays[0]};
    b.normals = {cross(right, up), cross(up, rays[0]), cross(right, rays[0])};
    if (!v.orthographic) {
        b.edges.insert(b.edges.end(), {rays[1], rays[2], rays[3]});
        b.normals.insert(b.normals.end(), {cross(up, rays[1]), cross(right, rays[2])});
    }
    return b;
}

template <typename N, typename T>
body<N> make_body(const warpshadow::box3<T>& box, const glm::vec<3, T>& origin) {
    const vec<N> lo = make<N>(box.lo) - make<N>(origin);
    const vec<N> hi = make<N>(box.hi) - make<N>(origin);
    body<N> b;
    for (std::size_t i = 0; i < 8; ++i) {
        b.points.push_back({{(i & 1) != 0 ? hi[0] : lo[0], (i & 2) != 0 ? hi[1] : lo[1],
                             (i & 4) != 0 ? hi[2] : lo[2]}});
    }
    const N zero = N(0.0);
    const N one = N(1.0);
    b.edges = {vec<N>{{one, zero, zero}}, vec<N>{{zero, one, zero}}, vec<N>{{zero, zero, one}}};
    b.normals = b.edges;
    return b;
}

/// The hull of a body and the origin; edges and normals by brute force over all pairs and triples
/// of corners, most of which are no edges or faces: further axes do no harm.
template <typename N> body<N> hull_with_origin(const body<N>& a) {
    body<N> b = a;
    const vec<N> zero{{N(0.0), N(0.0), N(0.0)}};
    b.points.push_back(zero);
    for (const vec<N>& p : a.points) {
        b.edges.push_back(p);
    }
    for (const vec<N>& d : a.directions) {
        b.edges.push_back(d);
    }
    // faces through the origin: pairs of spokes
    std::vector<vec<N>> spokes = a.points;
    spokes.insert(spokes.end(), a.directions.begin(), a.directions.end());
    for (std::size_t i = 0; i < spokes.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            b.normals.push_back(cross(spokes[i], spokes[j]));
        }
    }
    return b;
}

/// Whether n separates a below from b above, exactly.
inline bool separates(const body<dyadic>& a, const body<dyadic>& b, const vec<dyadic>& n) {
    for (const auto& d : a.directions) {
        if (dot(n, d).sign() > 0) {
            return false;
        }
    }
    for (const auto& d : b.directions) {
        if (dot(n, d).sign() < 0) {
            return false;
        }
    }
    dyadic top = dot(n, a.points[0]);
    for (const auto& p : a.points) {
        const dyadic s = dot(n, p);
        top = top < s ? s : top;
    }
    for (const auto& p : b.points) {
        if (!(top < dot(n, p))) {
            return false;
        }
    }
    return true;
}

/// Answer for one axis, in long double.
///
/// Points are off by at most 8 units of 2^-64 of the largest coordinate E, projections by 16 more:
/// a gap above 2^-56 |n| E is one. To be sure of an overlap, the exact axis must be known: a cross
/// product longer than 2^-16 of the product of its factors (`size`) is within 2^-44 of its length,
/// and an overlap of 2^-40 |n| E is then one on the exact axis as well. Likewise for directions.
enum class verdict { apart, unclear, overlap };

inline verdict roughly(const body<long double>& a, const body<long double>& b,
                       const vec<long double>& n, long double size, long double extent) {
    using wide = long double;
    const wide length = std::sqrt(dot(n, n));
    const bool known = length > 0x1p-16L * size;
    const body<wide>* sets[2] = {&a, &b};
    wide lo[2];
    wide hi[2];
    for (int k = 0; k < 2; ++k) {
        lo[k] = hi[k] = dot(n, sets[k]->points[0]);
        for (const auto& p : sets[k]->points) {
            const wide s = dot(n, p);
            lo[k] = std::fmin(lo[k], s);
            hi[k] = std::fmax(hi[k], s);
        }
        for (const auto& d : sets[k]->directions) {
            const wide s = dot(n, d);
            if (!known || std::fabs(s) < 0x1p-40L * length * std::sqrt(dot(d, d))) {
                return verdict::unclear;
            }
            (s < 0 ? lo[k] : hi[k]) = s < 0 ? -std::numeric_limits<wide>::infinity()
                                            : std::numeric_limits<wide>::infinity();
        }
    }
    const wide gap = std::fmax(lo[1] - hi[0], lo[0] - hi[1]);
    if (gap > 0x1p-56L * length * extent) {
        return verdict::apart;
    }
    return known && gap < -0x1p-40L * length * extent ? verdict::overlap : verdict::unclear;
}

/// Whether two closed convex sets have a point in common: no axis separates them, the unclear ones
/// being tried exactly.
/// @param[out] exact whether the answer took exact arithmetic
inline bool intersect(const body<long double>& a, const body<long double>& b,
                      const body<dyadic>& exact_a, const body<dyadic>& exact_b, bool& exact) {
    using wide = long double;
    wide extent = 0;
    for (const auto* set : {&a, &b}) {
        for (const auto& p : set->points) {
            for (const wide x : p.v) {
                extent = std::fmax(extent, std::fabs(x));
            }
        }
    }
    const auto length = [](const vec<wide>& v) { return std::sqrt(dot(v, v)); };
    std::vector<std::pair<std::size_t, std::size_t>> unclear; // edges; or a normal and npos
    const std::size_t npos = static_cast<std::size_t>(-1);
    exact = false;
    for (std::size_t i = 0; i < a.normals.size() + b.normals.size(); ++i) {
        const bool first = i < a.normals.size();
        const vec<wide>& n = first ? a.normals[i] : b.normals[i - a.normals.size()];
        // the faces of frusta are spanned by edges that are far from parallel; others are too short
        const verdict v = roughly(a, b, n, length(n), extent);
        if (v == verdict::apart) {
            return false;
        }
        if (v == verdict::unclear) {
            unclear.emplace_back(i, npos);
        }
    }
    for (std::size_t i = 0; i < a.edges.size(); ++i) {
        for (std::size_t j = 0; j < b.edges.size(); ++j) {
            const verdict v = roughly(a, b, cross(a.edges[i], b.edges[j]),
                                      length(a.edges[i]) * length(b.edges[j]), extent);
            if (v == verdict::apart) {
                return false;
            }
            if (v == verdict::unclear) {
                unclear.emplace_back(i, j);
            }
        }
    }
    exact = !unclear.empty();
    for (const auto& [i, j] : unclear) {
        const vec<dyadic> n = j != npos              ? cross(exact_a.edges[i], exact_b.edges[j])
                              : i < a.normals.size() ? exact_a.normals[i]
                                                     : exact_b.normals[i - a.normals.size()];
        if (separates(exact_a, exact_b, n) || separates(exact_b, exact_a, n)) {
            return false;
        }
    }
    return true;
}

/// Whether two volumes (frusta or boxes) meet or touch; counts the pairs decided exactly.
template <typename A, typename B, typename T>
bool intersect(const A& a, const B& b, const glm::vec<3, T>& origin, long& exact) {
    bool took_exact = false;
    const bool met =
        intersect(make_body<long double>(a, origin), make_body<long double>(b, origin),
                  make_body<dyadic>(a, origin), make_body<dyadic>(b, origin), took_exact);
    exact += took_exact ? 1 : 0;
    return met;
}

using real = boost::multiprecision::cpp_bin_float_50;

template <typename T> vec<real> real_vec(const glm::vec<3, T>& v) {
    return {{real(v.x), real(v.y), real(v.z)}};
}

/// Smallest squared distance of the origin to a segment or a triangle, if below `best`.
inline void nearest_on_segment(const vec<real>& a, const vec<real>& b, real& best) {
    const vec<real> u = b - a;
    const real uu = dot(u, u);
    real t = uu > 0 ? real(-dot(a, u) / uu) : real(0);
    t = t < 0 ? real(0) : t > 1 ? real(1) : t;
    const vec<real> q = a + times(t, u);
    const real s = dot(q, q);
    best = s < best ? s : best;
}

inline void nearest_on_triangle(const vec<real>& a, const vec<real>& b, const vec<real>& c,
                                real& best) {
    nearest_on_segment(a, b, best);
    nearest_on_segment(b, c, best);
    nearest_on_segment(c, a, best);
    const vec<real> n = cross(b - a, c - a);
    const real nn = dot(n, n);
    if (!(nn > 0)) {
        return;
    }
    const real height = dot(n, a);
    const vec<real> foot = times(real(height / nn), n);
    const bool over = dot(cross(n, b - a), foot - a) >= 0 && dot(cross(n, c - b), foot - b) >= 0 &&
                      dot(cross(n, a - c), foot - c) >= 0;
    const real s = height * height / nn;
    if (over && s < best) {
        best = s;
    }
}

/// Squared distance of a point to the hull of points: over all triangles of them, zero if a
/// tetrahedron of them holds the point.
inline real square_distance(std::vector<vec<real>> points, const vec<real>& from) {
    for (auto& p : points) {
        p = p - from;
    }
    const std::size_t n = points.size();
    real best = dot(points[0], points[0]);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            for (std::size_t k = 0; k < j; ++k) {
                nearest_on_triangle(points[i], points[j], points[k], best);
            }
        }
    }
    if (best == 0) {
        return best;
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            for (std::size_t k = 0; k < j; ++k) {
                const real whole = dot(points[i], cross(points[j], points[k]));
                for (std::size_t m = 0; m < k && whole != 0; ++m) {
                    // the origin is within i, j, k, m: it is on the inner side of all four faces
                    const vec<real>* t[4] = {&points[i], &points[j], &points[k], &points[m]};
                    bool inside = true;
                    for (int face = 0; face < 4 && inside; ++face) {
                        const vec<real>& a = *t[face];
                        const vec<real>& b = *t[(face + 1) % 4];
                        const vec<real>& c = *t[(face + 2) % 4];
                        const vec<real>& d = *t[(face + 3) % 4];
                        const vec<real> plane = cross(b - a, c - a);
                        const real thickness = dot(plane, d - a);
                        // four corners of one face are flat to 50 digits
                        inside = thickness * thickness >
                                     real("1e-70") * dot(plane, plane) * dot(d - a, d - a) &&
                                 thickness * -dot(plane, a) > 0;
                    }
                    if (inside) {
                        return real(0);
                    }
                }
            }
        }
    }
    return best;
}

/// The corners of a frustum in 50 digits.
template <typename T> std::vector<vec<real>> corners_of(const warpshadow::frustum<T>& f) {
    std::vector<vec<real>> corners;
    const auto& v = f.volume;
    for (int i = 0; i < 8; ++i) {
        const real x = (i & 1) != 0 ? v.right : v.left;
        const real y = (i & 2) != 0 ? v.top : v.bottom;
        const real d = (i & 4) != 0 ? v.far_distance : v.near_distance;
        const real s = v.orthographic ? real(1) : d;
        corners.push_back(real_vec(f.eye) + times(real(s * x), real_vec(f.right)) +
                          times(real(s * y), real_vec(f.up)) + times(d, real_vec(f.forward)));
    }
    return corners;
}

template <typename T>
real square_distance(const warpshadow::frustum<T>& f, const glm::vec<3, T>& from) {
    return square_distance(corners_of(f), real_vec(from));
}

} // namespace oracle
