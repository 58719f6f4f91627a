// Straight lines through measured points.
#pragma once

#include <span>

namespace feldspar {

/// y = intercept + slope x.
struct Line {
    double slope;
    double intercept;
};

/// The least-squares line of y over x. Both not-a-number when there are not two different x, or a value is not finite.
Line regression_line(std::span<const double> x, std::span<const double> y);

}  // namespace feldspar
