#include "feldspar/study/packings.hpp"

#include <algorithm>

#include "feldspar/base/error.hpp"
#include "feldspar/base/units.hpp"

namespace feldspar {
namespace {

// What the specimen follows from: the part of the resolved job that is about it, and the seed.
std::string key_of(const Run& run) {
    Job job = run.job;
    job.specimen = specimen_of(run.job, run.test());
    job.variants = {Variant{}};
    job.tests = {TestSpec{}};
    job.name = "specimen";
    job.laboratory.clear();
    job.laboratory_confined.clear();
    job.threads = job.at_once = 0;
    return resolved_toml(job) + format_exact(job.specimen.outline.flat_angle_rad);   // flats stand with the test in a job
}

}  // namespace

std::shared_ptr<const Specimen> Packings::get(const Run& run, int threads) {
    const std::string key = key_of(run);
    std::promise<std::shared_ptr<const Specimen>> promise;
    std::unique_lock lock(mutex_);
    std::erase(used_, key);
    used_.push_back(key);
    if (const auto found = made_.find(key); found != made_.end()) {
        const Made made = found->second;
        lock.unlock();
        return made.get();
    }
    const Made made = promise.get_future().share();
    made_[key] = made;
    for (; used_.size() > kept_; used_.pop_front()) made_.erase(used_.front());
    lock.unlock();
    try {
        SpecimenControl control;
        control.threads = threads;
        control.progress = [this](const SpecimenProgress&) {
            if (stop_ != nullptr && *stop_) throw Interrupted();
        };
        promise.set_value(std::make_shared<const Specimen>(make_specimen(specimen_of(run.job, run.test()), run.seed(), control)));
    } catch (...) {
        promise.set_exception(std::current_exception());
        throw;
    }
    return made.get();
}

}  // namespace feldspar
