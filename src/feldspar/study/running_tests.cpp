#include "feldspar/study/running_tests.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "feldspar/base/thread_shares.hpp"

namespace feldspar {

struct RunningTests::Test {
    std::size_t number = 0;
    int useful = 1;
    std::atomic<int> threads{1};
    std::optional<TestProgress> news;  // not told yet
    std::optional<TestResult> result;
    std::exception_ptr error;
    bool ended = false;
    std::jthread thread;  // last: it is joined before the rest goes away
};

RunningTests::RunningTests(const Sharing& sharing, std::atomic<bool>& stop) : sharing_(sharing), stop_(stop) {}

RunningTests::~RunningTests() {
    if (!tests_.empty()) stop_ = true;
    tests_.clear();  // waits for them while what they share is still there
}

int RunningTests::count() const { return static_cast<int>(tests_.size()); }

int RunningTests::free_threads() const {
    int used = 0;
    for (const auto& test : tests_) used += test->threads;
    return sharing_.threads() - used;
}

// Most tests at once that go with such a one and with those that run.
int RunningTests::company_with(int bodies) const {
    const int most = sharing_.most_at_once(bodies);
    return tests_.empty() ? most : std::min(most, company_);
}

bool RunningTests::has_room_for(int bodies) const { return free_threads() > 0 && count() < company_with(bodies); }

void RunningTests::start(std::size_t number, int bodies, std::size_t waiting, Work work) {
    company_ = company_with(bodies);
    const int places = std::min(company_ - count(), static_cast<int>(waiting));
    auto test = std::make_unique<Test>();
    test->number = number;
    test->useful = sharing_.useful_threads(bodies);
    test->threads = share_for_next(free_threads(), places, test->useful);
    Test& own = *test;
    tests_.push_back(std::move(test));
    own.thread = std::jthread([this, &own, work = std::move(work)] { run(own, work); });
}

void RunningTests::run(Test& test, const Work& work) {
    RunControl control;
    control.threads = test.threads;
    control.more_threads = &test.threads;
    control.stop = &stop_;
    control.progress = [&](const TestProgress& progress) {
        const std::lock_guard lock(mutex_);
        test.news = progress;
        happened_ = true;
        something_.notify_one();
    };
    std::optional<TestResult> result;
    std::exception_ptr error;
    try {
        result = work(control);
    } catch (...) {
        error = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    test.result = std::move(result);
    test.error = error;
    test.ended = true;
    happened_ = true;
    something_.notify_one();
}

void RunningTests::share_out_free_threads() {
    const int free = free_threads();
    if (free <= 0) return;
    std::vector<int> threads, useful;
    for (const auto& test : tests_) {
        threads.push_back(test->threads);
        useful.push_back(test->useful);
    }
    const std::vector<int> shares = shares_with(free, threads, useful);
    for (std::size_t i = 0; i < tests_.size(); ++i) tests_[i]->threads = shares[i];
}

RunningTests::Events RunningTests::events(bool patient) {
    Events events;
    std::vector<std::unique_ptr<Test>> over;  // their threads are joined when the lock is open again
    std::unique_lock lock(mutex_);
    if (patient && !tests_.empty()) something_.wait(lock, [this] { return happened_; });
    happened_ = false;
    for (std::unique_ptr<Test>& test : tests_) {
        if (test->news && !test->ended) events.news.push_back({test->number, *std::exchange(test->news, std::nullopt)});
        if (!test->ended) continue;
        events.ended.push_back({test->number, std::move(test->result), test->error});
        over.push_back(std::move(test));
    }
    std::erase(tests_, nullptr);
    lock.unlock();
    return events;
}

}  // namespace feldspar
