#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/printable.hpp"
#include "feldspar/base/units.hpp"

namespace feldspar {
namespace {

struct Good {
    const char* text;
    Dimension dimension;
    double value;
};

TEST(Units, ReadsQuantitiesExactly) {
    const std::vector<Good> cases{
        {"80 mm", Dimension::length, 0.08},
        {"3mm", Dimension::length, 0.003},
        {"  +0.25  mm ", Dimension::length, 0.00025},
        {"1.1 mm", Dimension::length, 0.0011},
        {"250 um", Dimension::length, 0.00025},
        {"250 \xC2\xB5m", Dimension::length, 0.00025},
        {"-2 cm", Dimension::length, -0.02},
        {"0 mm", Dimension::length, 0.0},
        {"1 in", Dimension::length, 0.0254},
        {"25.8 GPa", Dimension::stress, 25.8e9},
        {"8.5 MPa", Dimension::stress, 8.5e6},
        {"29.75 MPa", Dimension::stress, 29.75e6},
        {"1 N/mm2", Dimension::stress, 1e6},
        {"1 N/mm^2", Dimension::stress, 1e6},
        {"1 kN m-2", Dimension::stress, 1e3},
        {"2650 kg/m3", Dimension::density, 2650.0},
        {"2.65 g/cm3", Dimension::density, 2650.0},
        {"2.65 t/m3", Dimension::density, 2650.0},
        {"2650 kg m-3", Dimension::density, 2650.0},
        {"18.00e4 GPa/m", Dimension::stiffness_gradient, 18e13},
        {"180 GPa/mm", Dimension::stiffness_gradient, 18e13},
        {"20 N/m", Dimension::fracture_energy, 20.0},
        {"20 J/m2", Dimension::fracture_energy, 20.0},
        {"0.02 kJ/m2", Dimension::fracture_energy, 20.0},
        {"20 mN/mm", Dimension::fracture_energy, 20.0},
        {"5 mm/s", Dimension::speed, 0.005},
        {"6.25e-9 m", Dimension::speed_per_step, 6.25e-9},
        {"6.25e-9 m/step", Dimension::speed_per_step, 6.25e-9},
        {"6.25 nm / step", Dimension::speed_per_step, 6.25e-9},
        {"10 ns", Dimension::time, 1e-8},
        {"1e-8 s", Dimension::time, 1e-8},
        {"2 min", Dimension::time, 120.0},
        {"180 deg", Dimension::angle, std::numbers::pi},
        {"90 degrees", Dimension::angle, std::numbers::pi / 2},
        {"45\xC2\xB0", Dimension::angle, std::numbers::pi / 4},
        {"1.25 rad", Dimension::angle, 1.25},
        {"0.5 %", Dimension::fraction, 0.005},
        {"10%", Dimension::fraction, 0.1},
        {"0.25", Dimension::fraction, 0.25},
    };
    for (const Good& good : cases) {
        SCOPED_TRACE(good.text);
        double value = std::nan("");
        ASSERT_NO_THROW(value = parse_quantity(good.text, good.dimension));
        // decimal units add no rounding: the very double that the SI literal is (angles, inches: to an ulp)
        EXPECT_DOUBLE_EQ(value, good.value);
    }
    EXPECT_EQ(parse_quantity("29.75 MPa", Dimension::stress), 29.75e6);
    EXPECT_EQ(parse_quantity("0.29 mm", Dimension::length), 0.00029);
    EXPECT_EQ(parse_quantity("9 mm", Dimension::length), 0.009);  // 9 x 0.001 is the next double
    EXPECT_EQ(parse_quantity("2.65 g/cm3", Dimension::density), 2650.0);
}

struct Bad {
    const char* text;
    Dimension dimension;
    const char* problem;     // part of the problem
    const char* suggestion;  // part of the suggestion, "" = none wanted
};

TEST(Units, RefusesWithAReason) {
    const std::vector<Bad> cases{
        {"", Dimension::length, "empty", ""},
        {"   ", Dimension::length, "empty", ""},
        {"80", Dimension::length, "has no unit", ""},
        {"mm", Dimension::length, "does not begin with a number", ""},
        {"GPa 25.8", Dimension::stress, "does not begin with a number", ""},
        {"- 5 mm", Dimension::length, "does not begin with a number", ""},
        {"+-5 mm", Dimension::length, "does not begin with a number", ""},
        {"80 MPa", Dimension::length, "is a stress, not a length", ""},
        {"25 MPa/m", Dimension::stress, "is a stiffness per area, not a stress", ""},
        {"25 GPa", Dimension::stiffness_gradient, "is a stress, not a stiffness per area", ""},
        {"20 J", Dimension::fracture_energy, "is an energy, not a fracture energy", ""},
        {"5 Pa-1", Dimension::stress, "is not a stress", ""},  // udunits would take the reciprocal
        {"5 s/m", Dimension::speed, "is not a speed", ""},
        {"5 Hz", Dimension::time, "is not a time", ""},
        {"4 mPa", Dimension::stress, "thousandth of a pascal", "did you mean 'MPa'?"},
        {"4 mPa/m", Dimension::stiffness_gradient, "thousandth", "did you mean 'MPa/m'?"},
        {"4 Mpa", Dimension::stress, "'Mpa' is not a unit used here", "did you mean 'MPa'?"},
        {"4 gpa", Dimension::stress, "'gpa'", "did you mean 'GPa'?"},
        {"4 KPa", Dimension::stress, "'KPa'", "did you mean 'kPa'?"},
        {"80 Mm", Dimension::length, "'Mm'", "did you mean 'mm'?"},
        {"80 MM", Dimension::length, "'MM'", "did you mean 'mm'?"},
        {"2.6 T/m3", Dimension::density, "'T'", "did you mean 't/m3'?"},
        {"2.6 T.m-3", Dimension::density, "'T'", "did you mean 't.m-3'?"},
        {"20 n/m", Dimension::fracture_energy, "'n'", "did you mean 'N/m'?"},
        {"1.2 MPa m1/2", Dimension::stress, "is not a unit", ""},
        {"5 MPa 3", Dimension::stress, "is not a unit", ""},
        {"5 3 MPa", Dimension::stress, "is not a unit", ""},
        {"5 MPa;", Dimension::stress, "is not a unit", ""},
        {"5 (MPa)", Dimension::stress, "is not a unit", ""},
        {"5 MPa/", Dimension::stress, "is not a unit", ""},
        {"5 MPa m-", Dimension::stress, "is not a unit", ""},
        {"5 MPa @ 3", Dimension::stress, "is not a unit", ""},
        {"5 MPa since 3", Dimension::stress, "is not a unit", ""},
        {"5 parsnips", Dimension::length, "unknown unit 'parsnips'", ""},
        {"5,5 mm", Dimension::length, "point, not a comma", ""},
        {"inf mm", Dimension::length, "not a finite number", ""},
        {"-inf mm", Dimension::length, "not a finite number", ""},
        {"nan mm", Dimension::length, "not a finite number", ""},
        {"1e999 mm", Dimension::length, "out of range", ""},
        {"1e308 km", Dimension::length, "not a finite number", ""},
        {"0x10 mm", Dimension::length, "unknown unit 'x10 mm'", ""},
        {"53", Dimension::angle, "has no unit", ""},
        {"53 %", Dimension::angle, "is a fraction, not an angle", ""},
        {"53 mm", Dimension::angle, "is a length, not an angle", ""},
        {"53 deg", Dimension::stress, "is an angle, not a stress", ""},
        {"53 Deg", Dimension::angle, "'Deg'", "did you mean 'deg'?"},
        {"5 %", Dimension::length, "is a fraction, not a length", ""},
        {"5 MPa %", Dimension::stress, "percentage in its unit", ""},
        {"5 MPa rad", Dimension::stress, "an angle in its unit", ""},
        {"5 mm", Dimension::fraction, "is a length, not a fraction", ""},
        {"5 deg", Dimension::fraction, "is an angle, not a fraction", ""},
        {"5 m/s", Dimension::speed_per_step, "is a speed, not a length per step", ""},
        {"5 /step", Dimension::speed_per_step, "not a unit", ""},
        {"5 degC", Dimension::length, "not a length", ""},
    };
    for (const Bad& bad : cases) {
        SCOPED_TRACE(std::string("'") + bad.text + "'");
        try {
            const double value = parse_quantity(bad.text, bad.dimension);
            ADD_FAILURE() << "accepted as " << value;
        } catch (const InputError& error) {
            EXPECT_NE(error.problem().find(bad.problem), std::string::npos) << error.problem();
            EXPECT_NE(error.allowed().find(describe(bad.dimension)), std::string::npos) << error.allowed();
            if (*bad.suggestion != '\0')
                EXPECT_EQ(error.suggestion(), bad.suggestion);
            else
                EXPECT_EQ(error.suggestion(), "");
        }
    }
}

TEST(Units, WritesWhatItReadsBackBitForBit) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> mantissa(0.1, 1.0), exponent(-12.0, 14.0);
    for (Dimension dimension :
         {Dimension::length, Dimension::stress, Dimension::density, Dimension::stiffness_gradient, Dimension::fracture_energy,
          Dimension::speed, Dimension::speed_per_step, Dimension::time, Dimension::angle, Dimension::fraction}) {
        for (int i = 0; i < 200; ++i) {
            const double value = mantissa(random) * std::pow(10.0, exponent(random));
            EXPECT_EQ(parse_quantity(format_si(value, dimension), dimension), value) << format_si(value, dimension);
        }
        EXPECT_EQ(parse_quantity(format_si(0.0, dimension), dimension), 0.0);
    }
}

TEST(Units, ExamplesAreWhatTheySay) {
    for (int i = 0; i < 10; ++i) {
        const auto dimension = static_cast<Dimension>(i);
        EXPECT_NO_THROW(parse_quantity(example(dimension), dimension)) << example(dimension);
    }
}

TEST(Units, MayBeUsedFromSeveralThreads) {
    std::vector<std::thread> threads;
    std::vector<int> wrong(4, 0);
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([t, &wrong] {
            for (int i = 0; i < 200; ++i)
                wrong[static_cast<std::size_t>(t)] += parse_quantity("25.8 GPa", Dimension::stress) != 25.8e9;
        });
    for (std::thread& thread : threads) thread.join();
    for (int count : wrong) EXPECT_EQ(count, 0);
}

TEST(Units, RubbishNeverCrashes) {
    std::mt19937_64 random(11);
    const std::string alphabet = "0123456789.eE+-*/^ mMPaGkNJsd%()@,;\xC2\xB0\t\"'\\";
    for (int i = 0; i < 3000; ++i) {
        std::string text;
        for (std::uint64_t n = random() % 14; n > 0; --n) text += alphabet[random() % alphabet.size()];
        try {
            EXPECT_TRUE(std::isfinite(parse_quantity(text, static_cast<Dimension>(random() % 10)))) << text;
        } catch (const InputError&) {
        }
    }
}

TEST(Printable, ShowsControlCharactersEscaped) {
    EXPECT_EQ(printable("a \x1b[31mred\x7f\r"), "a \\x1b[31mred\\x7f\\x0d");
    EXPECT_EQ(printable("\xc2\x9b"
                        "31m"),
              "\\x9b"
              "31m");
    EXPECT_EQ(printable("Größe, σ\n\tµm"), "Größe, σ\n\tµm");
    EXPECT_EQ(printable(std::string_view("\0", 1)), "\\x00");
    EXPECT_EQ(printable("one\r\ntwo\rthree"), "one\r\ntwo\\x0dthree");
    EXPECT_EQ(printable("one\r\n\ttwo", LineEnds::escaped), "one\\x0d\\x0a\\x09two");
}

}  // namespace
}  // namespace feldspar
