// The list of test methods.
#include "feldspar/methods/method.hpp"

namespace feldspar {
namespace {

// A laboratory wraps the disc in a layer of masking tape, about 0.25 mm of a modulus near 0.4 GPa (docs/decisions, fixture of the Brazilian test).
constexpr double tape_Kn_Pa_m = 1.6e12;

}  // namespace

const TestMethod& method_of(TestKind kind) {
    for (const TestMethod* method : {&methods::uniaxial_compression, &methods::direct_tension, &methods::biaxial, &methods::brazilian,
                                     &methods::three_point_bend, &methods::semi_circular_bend, &methods::hole_compression, &methods::custom})
        if (method->kind == kind) return *method;
    return methods::uniaxial_compression;   // never: every kind has its method
}

TestSpec usual_test(TestKind kind, bool flattened) {
    TestSpec test;
    test.kind = kind;
    test.stop_fraction = method_of(kind).loading.stop_fraction;
    if (method_of(kind).specimen.own_disc && !flattened) {
        test.plates = PlateShape::curved;
        test.plate_Kn_Pa_m = tape_Kn_Pa_m;
    }
    return test;
}

}  // namespace feldspar
