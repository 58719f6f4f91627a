// The keys of a job for editors.
#pragma once

#include <string>

namespace feldspar {

/// A JSON Schema (Draft 4) of job files: every table and key with its type, words, range, meaning and default. A file that it
/// accepts may still be refused by read_job(), which knows what keys are to each other; a file that it refuses is no job.
std::string job_schema();

}  // namespace feldspar
