#include "feldspar/lab/keep_test.hpp"

#include "feldspar/base/stopwatch.hpp"

namespace feldspar {

TestKeeping::TestKeeping(StateKeeper* keeper) : keeper_(keeper) {
    if (keeper_ == nullptr) return;
    data_ = keeper_->kept();
    if (data_.empty()) return;
    reader_.emplace(data_);
    reader_->read(finished_before_);
}

bool TestKeeping::take_finished(TestResult& result) {
    if (!reader_ || finished_.size() >= finished_before_) return false;
    keep_course(*reader_, result);
    add_finished(result);
    return true;
}

void TestKeeping::add_finished(TestResult result) {
    if (keeper_ != nullptr) finished_.push_back(std::move(result));
}

void TestKeeping::begin(const ExperimentState& base) {
    start_ = std::chrono::steady_clock::now();
    before_s_ = 0.0;
    if (keeper_ == nullptr) return;
    base_ = StateBase::of(base);
    if (reader_) reader_->read(waiting_);
}

double TestKeeping::seconds() const { return before_s_ + seconds_since(start_); }

}  // namespace feldspar
