#include "feldspar/study/ranked_job.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/state_archive.hpp"
#include "feldspar/fast/kernels.hpp"
#include "feldspar/ranks/ranked_steps.hpp"
#include "feldspar/study/job_place.hpp"
#include "feldspar/study/packings.hpp"
#include "feldspar/study/planned_runs.hpp"

namespace feldspar {
namespace {

std::string machine_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "a machine without a name";
}

// What a rank says of itself.
struct Card {
    std::string machine, mistake, version, kernels, job;
};

constexpr char kEnd = '\0';  // of a text in a message

std::string text_of(const Card& card) {
    std::string text;
    for (const std::string* part : {&card.machine, &card.mistake, &card.version, &card.kernels, &card.job}) text += *part + kEnd;
    return text;
}

Card card_of(std::span<const char> text) {
    Card card;
    auto at = text.begin();
    for (std::string* part : {&card.machine, &card.mistake, &card.version, &card.kernels, &card.job}) {
        const auto end = std::find(at, text.end(), kEnd);
        part->assign(at, end);
        at = end == text.end() ? end : end + 1;
    }
    return card;
}

// Which run is next; none: the job is over.
std::vector<char> order(std::optional<std::size_t> run) {
    const std::int64_t number = run ? static_cast<std::int64_t>(*run) : -1;
    std::vector<char> bytes(sizeof number);
    std::memcpy(bytes.data(), &number, sizeof number);
    return bytes;
}

// States are kept when the first rank says so, and by it; what it has kept goes to all.
class RankedKeeper final : public StateKeeper {
public:
    /// @param of_first  the first rank's; null on others
    RankedKeeper(Communicator& ranks, StateKeeper* of_first) : ranks_(ranks), of_first_(of_first) {}

    bool due(bool stopped) override { return as_the_first(ranks_, of_first_ != nullptr && of_first_->due(stopped)); }
    void keep(const std::function<void(const StatePut&)>& write) override {
        if (of_first_ != nullptr) of_first_->keep(write);
    }
    std::vector<char> kept() override {
        return ranks_.from_first(of_first_ != nullptr ? of_first_->kept() : std::vector<char>());
    }
    void refuse(const std::string& reason) override {
        if (of_first_ != nullptr) of_first_->refuse(reason);
    }

private:
    Communicator& ranks_;
    StateKeeper* of_first_;
};

}  // namespace

TestResult run_ranked(Communicator& ranks, const TestSetup& setup, RunControl control) {
    RankedKeeper keeper(ranks, control.keeper);
    control.keeper = &keeper;
    control.agree = [&ranks](bool here) { return as_the_first(ranks, here); };
    control.device = [&ranks] { return open_ranks(ranks); };
    return run_test(setup, control);
}

Job read_together(Communicator& ranks, const std::function<Job()>& read, const Provenance& provenance) {
    std::optional<Job> job;
    std::exception_ptr mistake;
    Card own{machine_name(), {}, provenance.version + " " + provenance.commit, best_kernels().name, {}};
    try {
        job = read();
        own.job = identity_of_job(*job);
    } catch (const InputError& error) {
        mistake = std::current_exception();
        own.mistake = error.what();
    }
    Gathered all;
    ranks.gather(text_of(own), all);
    std::vector<Card> cards;
    for (const std::span<const char> part : all.of_rank) cards.push_back(card_of(part));
    if (!cards.front().mistake.empty()) {  // most likely that of all
        if (mistake && ranks.first()) std::rethrow_exception(mistake);
        throw InputError({.key = "mpirun"}, cards.front().mistake);
    }
    for (std::size_t rank = 1; rank < cards.size(); ++rank) {
        const Card &first = cards.front(), &card = cards[rank];
        const auto refuse = [&](const std::string& problem, const char* allowed) {
            throw InputError({.key = "mpirun"}, fmt::format("rank {}, on {}, {}", rank, card.machine, problem), allowed);
        };
        if (!card.mistake.empty())
            refuse("cannot read the job: " + card.mistake, "the same files in the same place on all machines");
        if (card.version != first.version)
            refuse(fmt::format("is version {} of the program, the first rank version {}", card.version, first.version),
                   "one version on all machines");
        if (card.kernels != first.kernels)
            refuse(fmt::format("has the vector instructions {}, the first rank {}", card.kernels, first.kernels),
                   "FELDSPAR_KERNELS=avx2, or portable, for all ranks (mpirun -x FELDSPAR_KERNELS=avx2)");
        if (card.job != first.job)
            refuse("has another job than the first rank", "the same job, and files that it names, on all machines");
    }
    return std::move(*job);
}

JobLeader::~JobLeader() {
    try {
        (void)ranks_.from_first(order({}));
    } catch (const RankLost&) {  // nobody is there to be told
    }
}

TestResult JobLeader::run(std::size_t run, const TestSetup& setup, RunControl control) {
    (void)ranks_.from_first(order(run));
    try {
        return run_ranked(ranks_, setup, std::move(control));
    } catch (const std::bad_alloc&) {  // here alone: the others wait in the middle of the test
        ranks_.give_up(static_cast<int>(ExitCode::numerical));
        throw;
    }
}

void follow_job(const Job& job, Communicator& ranks, int threads, const std::atomic<bool>& stop) {
    const std::vector<PlannedRun> runs = planned_runs(job);
    Packings packings(runs.size(), nullptr);  // the first rank says when all end
    try {                                     // while the first rank makes them, too
        for (const PlannedRun& run : runs) (void)packings.get(specimen_of(run), run.seed, threads);
    } catch (const InputError&) {  // these are thrown by all ranks, and the first one tells
    } catch (const NumericalError&) {
    }
    for (;;) {
        std::int64_t number = -1;
        const std::vector<char> next = ranks.from_first({});
        if (next.size() != sizeof number) throw RankLost("the first rank has given another order than was expected");
        std::memcpy(&number, next.data(), sizeof number);
        if (number < 0) return;
        const PlannedRun& run = runs.at(static_cast<std::size_t>(number));
        RunControl control;
        control.threads = threads;
        control.stop = &stop;
        try {
            (void)run_ranked(ranks, setup_of(run, packings.get(specimen_of(run), run.seed, threads)), control);
        } catch (const InputError&) {  // as above
        } catch (const NumericalError&) {
        } catch (const Interrupted&) {
        }
    }
}

}  // namespace feldspar
