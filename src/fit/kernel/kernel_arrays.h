// The arithmetic of the fit's inner loop on arrays, in SIMD with run-time dispatch. Lengths n are multiples of 8, the
// widest vector; arrays are padded by the caller.
#pragma once

#include <cstddef>

namespace lobefit::arrays {

// p5 = (1 - cos_d)^5 and 1 - p5: Schlick's factor is f0 + (1 - f0) p5, its derivative by f0 1 - p5 (n a multiple of the
// lanes).
void Schlick(const double* cos_d, std::size_t n, double* p5, double* one_minus_p5);

// The Fresnel curve's basis (fresnel.h): to[k] of kFresnelCurveSize arrays `stride` apart.
void CurveBasis(const double* cos_d, std::size_t n, std::size_t stride, double* to);

// to[k] = sum_j jacobian[j][k] from[j], j < rows, k < columns, arrays of n with the given strides.
void Contract(const double* from, const double* jacobian, std::size_t rows, std::size_t columns, std::size_t n,
              std::size_t stride, double* to);

// to += a * (constant + slope * array).
void AddFactor(const double* a, double constant, double slope, const double* array, std::size_t n, double* to);

// to += factor * a.
void AddScaled(const double* a, double factor, std::size_t n, double* to);

// to = sqrt(scale * to).
void FinishWeight(double scale, std::size_t n, double* to);

// to *= sine of the angle whose cosine is given.
void TimesSine(const double* cosine, std::size_t n, double* to);

// Shape columns of one lobe and channel: to[k] = slope * (constant + factor_slope * factor) * gradient[k], plus slope *
// albedo * diffuse_gradient[k] where that is not null.
void ShapeColumn(const double* slope, double constant, double factor_slope, const double* factor,
                 const double* gradient, double albedo, const double* diffuse_gradient, std::size_t columns,
                 std::size_t n, std::size_t stride, double* to);

// to += slope * specular * scale * by_argument * gradient: what moves a mean's Fresnel argument; by_argument null: 1.
void AddArgumentColumn(const double* slope, const double* specular, double scale, const double* by_argument,
                       const double* gradient, std::size_t n, double* to);

// to = a * b * c.
void Product(const double* a, const double* b, const double* c, std::size_t n, double* to);

// to = a * b.
void Multiply(const double* a, const double* b, std::size_t n, double* to);

// Sum of squares.
double SumOfSquares(const double* a, std::size_t n);

// Adds the upper triangle of the Gram matrix of `columns` arrays to `gram`, row by row.
void AddGram(const double* columns, std::size_t count, std::size_t n, std::size_t stride, double* gram);

}  // namespace lobefit::arrays
