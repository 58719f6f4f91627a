// plan.json of a study on Slurm.
#include "feldspar/study/slurm_plan.hpp"

#include "fuzz.hpp"

namespace feldspar::fuzz {

void slurm_plan(std::string_view input) {
    const std::filesystem::path file = file_with("plan.json", input);
    read_or_refuse([&] {
        const SlurmPlan plan = read_plan(file.parent_path());
        for (const auto& group : plan.groups)
            for (const std::string& id : group)
                if (plan.job_file(id).lexically_normal().parent_path() != (file.parent_path() / "jobs").lexically_normal())
                    throw Fault("a plan names a job outside its directory: " + id);
    });
}

}  // namespace feldspar::fuzz
