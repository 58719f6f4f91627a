// The objects that Python holds.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common.hpp"
#include "feldspar/base/units.hpp"
#include "feldspar/job/job.hpp"
#include "feldspar/lab/properties.hpp"
#include "feldspar/methods/result.hpp"
#include "feldspar/study/planned_runs.hpp"

namespace feldspar::python {

/// A specimen, and what its grains are made of in the job that it is of.
struct PySpecimen {
    std::shared_ptr<const Specimen> specimen;
    std::vector<int> phases;               ///< of each grain
    std::vector<std::string> phase_names;  ///< one at least
};

/// The record of one test.
struct PyResult {
    std::shared_ptr<const TestResult> result;
    PySpecimen specimen() const;
};

/// Which tests of a job are meant: by kind, name or label, or by number; nothing means all.
using TestChoice = std::variant<std::monostate, std::int64_t, std::string>;

/// A job with only those of its tests, variants and packings that are asked for. @param sigma3_Pa  only tests at this pressure
/// @throws InputError  if nothing is left, or a name is not one of the job
Job part_of(const Job& job, const std::vector<TestChoice>& tests, const std::vector<std::string>& variants,
            const std::vector<std::uint64_t>& seeds, std::optional<double> sigma3_Pa = {});

/// A job with the single run that is asked for. Without a seed it is the first packing. @throws InputError  if several runs are
/// meant, or none
Job single_run(const Job& job, const TestChoice& test, std::optional<double> sigma3_Pa, std::optional<std::uint64_t> seed,
               const std::optional<std::string>& variant);

/// Grains of a rock on a specimen.
PySpecimen with_phases(std::shared_ptr<const Specimen> specimen, const GrainMaterial& grain, const ContactMaterial& contact,
                       const Heterogeneity& rock);

/// Threads that a caller asks for; 0: as many as there are cores. @throws InputError
int threads_of(int wanted);

/// Properties over packings, in user units: a dictionary of dictionaries.
py::dict properties_of(const PropertySummary& summary);
/// Strength envelopes, one dictionary a packing.
py::dict envelope_of(const PropertySummary& summary);

/// A quantity of an argument: a number in SI, or text with a unit. @param name  of the argument, for messages
double quantity_of(const py::object& given, Dimension dimension, const char* name);

}  // namespace feldspar::python
