// A job file, with all that is said of it before it runs. What the program writes of it must be a job with the same results.
#include "feldspar/job/job.hpp"

#include "fuzz.hpp"

namespace feldspar::fuzz {

void job(std::string_view input) {
    read_or_refuse([&] {
        const Job read = parse_job(std::string(input), "/nowhere/job.toml");
        (void)warnings(read);
        const std::string resolved = resolved_toml(read);
        try {
            if (resolved_toml(parse_job(resolved, "/nowhere/job-resolved.toml")) != resolved)
                throw Fault("the resolved job is read as another job:\n" + resolved);
        } catch (const InputError& error) {
            throw Fault(std::string("the resolved job is refused: ") + error.what() + "\n" + resolved);
        }
    });
}

}  // namespace feldspar::fuzz
