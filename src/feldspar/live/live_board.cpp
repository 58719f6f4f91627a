#include "feldspar/live/live_board.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "feldspar/base/stopwatch.hpp"
#include "feldspar/live/live_test.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::duration;
using std::chrono::duration_cast;

constexpr auto kBetweenLooks = std::chrono::milliseconds(300);
constexpr auto kBetweenFrames = std::chrono::milliseconds(1000);
constexpr double kTimesItsCost =
    100.0;  // a look is followed by so many times what it took: it takes at most a hundredth of the time
constexpr std::size_t kFirstPoints = 400, kNewPoints = 12;  // of a curve, at the first look and at each later one
constexpr std::size_t kMostPoints = 2400;                   // then every other one goes

LivePoint point_of(const HistoryRow& row) {
    return {static_cast<float>(row.axial_strain * 1e3), static_cast<float>(row.axial_stress_Pa * 1e-6), row.cracks_tensile,
            row.cracks_shear};
}

LiveCrack shown(const Crack& crack) {
    const auto mm = [](double m) { return static_cast<float>(m * 1e3); };
    return {mm(crack.from.x), mm(crack.from.y), mm(crack.to.x), mm(crack.to.y), static_cast<std::uint8_t>(crack.mode),
            crack.grain_a,    crack.grain_b};
}

LiveFrame frame_of(const GrainMesh& mesh, const std::vector<Vec2>& displacement_m) {
    std::vector<double> x, y;
    double largest = 0.0;
    for (std::size_t g = 0; g < mesh.vertex_count.size(); ++g)
        for (int k = 0; k < mesh.vertex_count[g]; ++k) {
            const Vec2 u = displacement_m[static_cast<std::size_t>(mesh.node_begin[g] + k)];
            x.push_back(u.x);
            y.push_back(u.y);
            largest = std::max({largest, std::abs(u.x), std::abs(u.y)});
        }
    LiveFrame frame;
    const double step_m = largest > 0.0 && std::isfinite(largest) ? largest / 32767.0 : 1.0;
    frame.scale_mm = step_m * 1e3;
    frame.steps.reserve(2 * x.size());
    for (const std::vector<double>* axis : {&x, &y})
        for (const double u : *axis)
            frame.steps.push_back(static_cast<std::int16_t>(std::lround(std::isfinite(u) ? u / step_m : 0.0)));
    return frame;
}

}  // namespace

void LiveBoard::Watch::see(const TestSight& sight) {
    const Clock::time_point start = Clock::now();
    wanted_ = false;
    const TestResult& result = sight.so_far();
    const bool again = &result != std::exchange(of_, &result) || result.passages != passages_ || result.history.size() < rows_ ||
                       result.cracks.size() < cracks_;
    if (again) rows_ = cracks_ = 0;
    passages_ = result.passages;
    std::vector<LivePoint> points;
    const std::size_t fresh = result.history.size() - rows_, most = rows_ == 0 ? kFirstPoints : kNewPoints,
                      stride = fresh / most + 1;
    for (std::size_t row = rows_; row < result.history.size(); ++row)
        if (row % stride == 0 || row + 1 == result.history.size()) points.push_back(point_of(result.history[row]));
    std::vector<LiveCrack> cracks;
    std::transform(result.cracks.begin() + static_cast<std::ptrdiff_t>(cracks_), result.cracks.end(), std::back_inserter(cracks),
                   shown);
    rows_ = result.history.size();
    cracks_ = result.cracks.size();
    {
        const std::lock_guard lock(board_.mutex_);
        if (again) {
            test_.curve.clear();
            test_.cracks.clear();
            ++test_.curve_round;
            ++test_.crack_round;
        }
        test_.curve.insert(test_.curve.end(), points.begin(), points.end());
        test_.cracks.insert(test_.cracks.end(), cracks.begin(), cracks.end());
        if (test_.curve.size() > kMostPoints) {
            std::size_t kept = 0;
            for (std::size_t i = 0; i < test_.curve.size(); i += 2) test_.curve[kept++] = test_.curve[i];
            test_.curve.resize(kept);
            ++test_.curve_round;
        }
        board_.news();
        test_.version = board_.version_;
    }
    if (start >= next_frame_) add_frame(sight, start);
    const Clock::time_point end = Clock::now();
    const double took_s = duration<double>(end - start).count();
    if (!first_) first_ = start;
    taken_s_ = taken_s_ + took_s;
    passed_s_ = duration<double>(end - *first_).count();
    not_before_ =
        (end + std::max<Clock::duration>(kBetweenLooks, duration_cast<Clock::duration>(duration<double>(kTimesItsCost * took_s))))
            .time_since_epoch()
            .count();
}

void LiveBoard::Watch::add_frame(const TestSight& sight, Clock::time_point now) {
    next_frame_ = now + kBetweenFrames;
    const Specimen* specimen = sight.so_far().specimen.get();
    if (specimen == nullptr || specimen->mesh.vertex_count.size() > kMostShownGrains) return;
    auto frame = std::make_shared<const LiveFrame>(frame_of(specimen->mesh, sight.displacements()));
    const std::lock_guard lock(board_.mutex_);
    test_.frame = std::move(frame);
    board_.news();
    test_.version = board_.version_;
}

LiveBoard::LiveBoard(std::string name, std::atomic<bool>& stop, LiveWords words)
    : name_(std::move(name)), words_(std::move(words)), stop_(stop) {}

LiveBoard::~LiveBoard() = default;

void LiveBoard::news() {
    ++version_;
    changed_.notify_all();
}

void LiveBoard::planned(std::vector<LivePlan> tests) {
    const std::lock_guard lock(mutex_);
    tests_.clear();
    for (LivePlan& plan : tests) {
        tests_.push_back(std::make_unique<Test>());
        tests_.back()->plan = std::move(plan);
    }
    news();
}

std::size_t LiveBoard::adds(LivePlan plan) {
    const std::lock_guard lock(mutex_);
    tests_.push_back(std::make_unique<Test>());
    tests_.back()->plan = std::move(plan);
    news();
    return tests_.size() - 1;
}

void LiveBoard::expects(std::size_t most) {
    const std::lock_guard lock(mutex_);
    most_ = most;
    news();
}

void LiveBoard::busy(const std::string& what) {
    const std::lock_guard lock(mutex_);
    busy_ = what;
    news();
}

TestWatch& LiveBoard::begins(std::size_t number, std::shared_ptr<const Specimen> specimen) {
    begins(number);
    const std::lock_guard lock(mutex_);
    Test& test = *tests_.at(number);
    test.specimen = std::move(specimen);
    test.watch = std::make_unique<Watch>(*this, test);
    return *test.watch;
}

void LiveBoard::begins(std::size_t number) {
    const std::lock_guard lock(mutex_);
    Test& test = *tests_.at(number);
    busy_.clear();
    test.state = LiveState::running;
    test.began = Clock::now();
    news();
    test.version = version_;
}

void LiveBoard::progress(std::size_t number, const TestProgress& state) {
    const std::lock_guard lock(mutex_);
    Test& test = *tests_.at(number);
    test.progress = state;
    news();
    test.version = version_;
}

void LiveBoard::waits(std::size_t number) {
    const std::lock_guard lock(mutex_);
    Test& test = *tests_.at(number);
    test.state = LiveState::waiting;
    test.forget();
    news();
    test.version = version_;
}

void LiveBoard::written(std::size_t number) {
    const std::lock_guard lock(mutex_);
    Test& test = *tests_.at(number);
    if (test.state != LiveState::running) return;
    test.state = LiveState::writing;
    test.took_s = seconds_since(test.began);
    news();
    test.version = version_;
}

void LiveBoard::ended(std::size_t number, const LiveResult& result) {
    const std::lock_guard lock(mutex_);
    Test& test = *tests_.at(number);
    if (test.state == LiveState::running) test.took_s = seconds_since(test.began);
    if (result.took_s > 0.0) test.took_s = result.took_s;
    test.state = result.state;
    test.words = result.words;
    test.forget();  // the report has all of it
    news();
    test.version = version_;
}

void LiveBoard::report(const std::filesystem::path& file) {
    const std::lock_guard lock(mutex_);
    report_ = file;
    ++reports_;
    news();
}

void LiveBoard::over(const std::string& words) {
    const std::lock_guard lock(mutex_);
    over_ = true;
    over_words_ = words;
    news();
}

std::filesystem::path LiveBoard::report_file() const {
    const std::lock_guard lock(mutex_);
    return report_;
}

bool LiveBoard::is_over() const {
    const std::lock_guard lock(mutex_);
    return over_;
}

std::string LiveBoard::over_words() const {
    const std::lock_guard lock(mutex_);
    return over_words_;
}

void LiveBoard::looked_at(bool begins) { watchers_ += begins ? 1 : -1; }

void LiveBoard::ask_tests() {
    const Clock::time_point now = Clock::now();
    const std::lock_guard lock(mutex_);
    for (const auto& test : tests_)
        if (test->state == LiveState::running && test->watch) test->watch->ask(now);
}

bool LiveBoard::end_test(std::size_t number) {
    const std::lock_guard lock(mutex_);
    if (number >= tests_.size() || tests_[number]->state != LiveState::running || !tests_[number]->watch) return false;
    tests_[number]->watch->end();
    return true;
}

void LiveBoard::end_run() {
    stop_ = true;
    const std::lock_guard lock(mutex_);
    ending_ = true;
    news();
}

std::uint64_t LiveBoard::wait(std::uint64_t version, std::chrono::milliseconds at_most) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, at_most, [&] { return version_ > version; });
    return version_;
}

double LiveBoard::cost() const {
    const std::lock_guard lock(mutex_);
    double taken = 0.0, passed = 0.0;
    for (const auto& test : tests_)
        if (test->watch) {
            taken += test->watch->taken_s();
            passed += test->watch->passed_s();
        }
    return passed > 0.0 ? taken / passed : 0.0;
}

// Of the run, s; negative where nothing is known. What waits takes as long as those of its kind took, else as all that ended,
// else as those that run expect of themselves.
double LiveBoard::seconds_left() const {
    struct Mean {
        double sum = 0.0;
        int count = 0;
        void add(double value) { sum += value, ++count; }
        double value() const { return sum / count; }
    };
    std::map<std::string, Mean> of_kind;
    Mean of_all, of_running;
    int running = 0;
    for (const auto& test : tests_) {
        if (test->took_s > 0.0) {
            of_kind[test->plan.kind].add(test->took_s);
            of_all.add(test->took_s);
        }
        if (test->state != LiveState::running) continue;
        ++running;
        if (test->progress && test->progress->seconds_left >= 0.0)
            of_running.add(seconds_since(test->began) + test->progress->seconds_left);
    }
    const auto expected = [&](const Test& test) {
        if (const auto kind = of_kind.find(test.plan.kind); kind != of_kind.end()) return kind->second.value();
        return of_all.count > 0 ? of_all.value() : of_running.count > 0 ? of_running.value() : -1.0;
    };
    double work = 0.0, longest = 0.0;
    for (const auto& test : tests_) {
        double left = 0.0;
        if (test->state == LiveState::waiting) {
            left = expected(*test);
            if (left < 0.0) return -1.0;
        } else if (test->state == LiveState::running) {
            if (test->progress && test->progress->seconds_left >= 0.0)
                left = test->progress->seconds_left;
            else if (const double whole = expected(*test); whole >= 0.0)
                left = std::max(0.0, whole - seconds_since(test->began));
            else
                return -1.0;
        }
        work += left;
        longest = std::max(longest, left);
    }
    if (most_ > tests_.size()) {  // tests of which nothing is known yet
        if (of_all.count == 0 && of_running.count == 0) return -1.0;
        const double each = of_all.count > 0 ? of_all.value() : of_running.value();
        work += each * static_cast<double>(most_ - tests_.size());
    }
    return std::max(longest, work / std::max(1, running));
}

}  // namespace feldspar
