#include "feldspar/model/own_laws.hpp"

#include <array>

namespace feldspar {
namespace {

// Each constant once; what concerns all of them loops over these.
template <class Number>
constexpr std::array<Number LawConstants<Number>::*, 7> all_constants{
    &LawConstants<Number>::Kn_Pa_m,  &LawConstants<Number>::Ks_Pa_m,     &LawConstants<Number>::x0_normal,
    &LawConstants<Number>::x0_shear, &LawConstants<Number>::x_fl_normal, &LawConstants<Number>::x_fl_shear,
    &LawConstants<Number>::mu};

}  // namespace

std::int32_t OwnLaws::add(const LawConstants<double>& law) {
    for (std::size_t i = 0; i < all_constants<double>.size(); ++i)
        (constants.*all_constants<Array<double>>[i]).push_back(law.*all_constants<double>[i]);
    return static_cast<std::int32_t>(constants.mu.size()) - 1;
}

LawConstants<double> OwnLaws::at(std::int32_t number) const {
    LawConstants<double> law;
    for (std::size_t i = 0; i < all_constants<double>.size(); ++i)
        law.*all_constants<double>[i] = (constants.*all_constants<Array<double>>[i])[number];
    return law;
}

double OwnLaws::memory_bytes() const {
    double sum = 0.0;
    for (const auto constant : all_constants<Array<double>>)
        sum += static_cast<double>((constants.*constant).capacity() * sizeof(double));
    return sum;
}

}  // namespace feldspar
