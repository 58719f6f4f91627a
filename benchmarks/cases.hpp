// What is measured: which specimen, in which state, which stage of the step, on how many threads. Plain data with names.
#pragma once

#include <compare>
#include <string>
#include <vector>

#include "feldspar/model/spec.hpp"

namespace feldspar::benchmarks {

enum class Load { uniaxial, brazilian };
enum class Size { paper, grains_16k, grains_100k };  ///< paper: 80 mm x 160 mm (1630 grains), or a disc of 80 mm (640)

enum class State {
    elastic,   ///< every bond intact
    relaxing,  ///< the same, damped viscously, as in the elastic start
    breaking   ///< 30 % of the points softened and 10 % broken, scattered over the whole specimen
};

enum class Stage { contacts, bodies, step, energies };  ///< energies: the sums of a record's ledger

/// What has to be built before anything can be measured.
struct SpecimenChoice {
    GrainKind grains = GrainKind::flexible;
    Load load = Load::uniaxial;
    Size size = Size::paper;
    auto operator<=>(const SpecimenChoice&) const = default;
};

struct Case {
    SpecimenChoice specimen;
    State state = State::elastic;
    Stage stage = Stage::step;
    int threads = 1;
};

const char* name(Load load);
const char* name(Size size);
const char* name(State state);
const char* name(Stage stage);

/// For example "flexible/uniaxial/16k".
std::string name(const SpecimenChoice& specimen);

/// For example "flexible/uniaxial/paper/elastic/step/1t": unique, and what a filter and a comparison go by.
std::string name(const Case& one);

/// How many grains the specimen will have, about.
int grain_count(const SpecimenChoice& specimen);

/// Lengths of the specimen over those of the paper's; the grains keep their size.
double length_scale(const SpecimenChoice& specimen);

/// Memory that building the specimen and measuring it take at most, bytes.
double needed_memory(const SpecimenChoice& specimen);

/// The cases of a run, those of one specimen together.
/// @param full     false: the steps of the paper's specimens, their stages, and the step of 16 k grains
/// @param threads  the numbers of threads, each at least 1
std::vector<Case> make_cases(bool full, const std::vector<int>& threads);

/// Cases whose name the regular expression finds. @throws InputError if it is none
std::vector<Case> filtered(const std::vector<Case>& cases, const std::string& expression);

/// What even the full run leaves out, and why, a line each.
std::vector<std::string> left_out();

}  // namespace feldspar::benchmarks
