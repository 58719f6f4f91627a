// Which packings a command that makes a study of a job takes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "feldspar/job/job.hpp"

namespace feldspar {

/// `wanted` packings: the job's seeds first, then the smallest that are not among them. Without `wanted` the job's seeds if there
/// are several, else `usual` packings. A job that loads a packing has that one. @throws InputError if it is asked for more
std::vector<std::uint64_t> choose_seeds(const Job& job, std::optional<int> wanted, int usual);

/// The disc that a Brazilian test of the job would take where the job has none: the specimen's grains, its width as the diameter.
/// Nothing for a polygon, which does not say how large a disc is to be.
std::optional<SpecimenSpec> usual_disc(const SpecimenSpec& specimen);

}  // namespace feldspar
