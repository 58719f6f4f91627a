// Ranks by MPI: the only file that knows it.
#define OMPI_SKIP_MPICXX 1  // the old bindings of C++, which need a library of their own
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <cstring>

#include "feldspar/base/error.hpp"
#include "feldspar/ranks/communicator.hpp"

namespace feldspar {
namespace {

constexpr std::size_t kUnit = 64;  // bytes that are counted together: MPI counts in int

std::size_t units_of(std::size_t bytes) { return (bytes + kUnit - 1) / kUnit; }

// MPI ends all programs itself when a call fails.
class Mpi final : public Communicator {
public:
    Mpi() {
        int granted = 0;
        MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &granted);
        if (granted < MPI_THREAD_SERIALIZED) {
            MPI_Finalize();
            throw InputError({.key = "mpirun"}, "this MPI does not allow calls from more than one thread, one after the other",
                             "Open MPI, or another that gives MPI_THREAD_SERIALIZED");
        }
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &size_);
        MPI_Comm here{};
        MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
        MPI_Comm_size(here, &on_this_machine_);
        MPI_Comm_free(&here);
        MPI_Type_contiguous(static_cast<int>(kUnit), MPI_BYTE, &unit_);
        MPI_Type_commit(&unit_);
    }
    ~Mpi() override {
        MPI_Type_free(&unit_);
        MPI_Finalize();
    }

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    int on_this_machine() const override { return on_this_machine_; }

    void exchange(std::span<const Transfer> transfers) override {
        requests_.clear();
        for (const Transfer& transfer : transfers)
            MPI_Irecv(transfer.in.data(), static_cast<int>(transfer.in.size()), MPI_BYTE, transfer.other, 0, MPI_COMM_WORLD,
                      &requests_.emplace_back());
        for (const Transfer& transfer : transfers)
            MPI_Isend(transfer.out.data(), static_cast<int>(transfer.out.size()), MPI_BYTE, transfer.other, 0, MPI_COMM_WORLD,
                      &requests_.emplace_back());
        MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
    }

    void gather(std::span<const char> own, Gathered& all) override {
        const unsigned long long bytes = own.size();
        std::vector<unsigned long long> each(static_cast<std::size_t>(size_));
        MPI_Allgather(&bytes, 1, MPI_UNSIGNED_LONG_LONG, each.data(), 1, MPI_UNSIGNED_LONG_LONG, MPI_COMM_WORLD);
        std::vector<int> count, place;
        std::size_t units = 0;
        for (const unsigned long long of_one : each) {
            place.push_back(static_cast<int>(units));
            count.push_back(static_cast<int>(units_of(of_one)));
            units += units_of(of_one);
        }
        out_.resize(kUnit * units_of(own.size()));
        if (!own.empty()) std::memcpy(out_.data(), own.data(), own.size());
        all.bytes.resize(kUnit * units);
        MPI_Allgatherv(out_.data(), count[static_cast<std::size_t>(rank_)], unit_, all.bytes.data(), count.data(), place.data(),
                       unit_, MPI_COMM_WORLD);
        all.of_rank.clear();
        for (std::size_t r = 0; r < each.size(); ++r)
            all.of_rank.emplace_back(all.bytes.data() + kUnit * static_cast<std::size_t>(place[r]), each[r]);
    }

    std::vector<char> from_first(std::vector<char> given) override {
        unsigned long long bytes = given.size();
        MPI_Bcast(&bytes, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
        given.resize(kUnit * units_of(bytes));
        MPI_Bcast(given.data(), static_cast<int>(units_of(bytes)), unit_, 0, MPI_COMM_WORLD);
        given.resize(bytes);
        return given;
    }

    void give_up(int code) noexcept override { MPI_Abort(MPI_COMM_WORLD, code); }

private:
    int rank_ = 0, size_ = 1, on_this_machine_ = 1;
    MPI_Datatype unit_{};
    std::vector<MPI_Request> requests_;
    std::vector<char> out_;
};

}  // namespace

bool built_with_mpi() { return true; }

std::unique_ptr<Communicator> communicator_here() {
    if (started_ranks() == 1) return alone();
    return std::make_unique<Mpi>();
}

}  // namespace feldspar
