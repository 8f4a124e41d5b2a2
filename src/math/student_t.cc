#include "lobefit/math/student_t.h"

#include <cmath>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

namespace lobefit {
namespace {

// In double: long double, which is Boost's choice, is ten times slower for nothing. NaN and infinity are values, not
// exceptions.
using boost::math::policies::ignore_error;
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>,
                                             boost::math::policies::domain_error<ignore_error>,
                                             boost::math::policies::overflow_error<ignore_error>>;
using StudentT = boost::math::students_t_distribution<double, Policy>;
using Normal = boost::math::normal_distribution<double, Policy>;

}  // namespace

double StudentTCdf(double x, double freedom) {
  if (std::isinf(x)) return x < 0 ? 0 : 1;
  return std::isinf(freedom) ? boost::math::cdf(Normal(), x) : boost::math::cdf(StudentT(freedom), x);
}

double StudentTQuantile(double probability, double freedom) {
  return std::isinf(freedom) ? boost::math::quantile(Normal(), probability)
                             : boost::math::quantile(StudentT(freedom), probability);
}

}  // namespace lobefit
