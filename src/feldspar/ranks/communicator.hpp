// Ranks: programs, on one machine or several, that make one test together. How they speak with each other; by MPI, or as threads
// of one program, for tests. Nothing outside this room knows MPI.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace feldspar {

/// Another rank has given up: what is said to a rank that waits for it.
class RankLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What goes to another rank, and what comes from it meanwhile. Both know how much.
struct Transfer {
    int other = 0;
    std::span<const char> out;
    std::span<char> in;
};

/// The parts of all ranks.
struct Gathered {
    std::vector<char> bytes;
    std::vector<std::span<const char>> of_rank;  ///< in these bytes
};

/// One rank's end of the line. All ranks make the same calls in the same order, each from one thread at a time. What a call
/// throws is RankLost.
class Communicator {
public:
    Communicator() = default;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;
    virtual ~Communicator() = default;

    /// From 0 on; the first reads and writes files, and prints.
    virtual int rank() const = 0;
    virtual int size() const = 0;
    /// How many of the ranks run on this machine, this one included.
    virtual int on_this_machine() const = 0;

    /// Sends and receives; at most one transfer with each other rank. Ranks without transfers may leave the call out.
    virtual void exchange(std::span<const Transfer> transfers) = 0;

    /// What every rank gives, to all.
    virtual void gather(std::span<const char> own, Gathered& all) = 0;

    /// What the first rank gives, to all; of others it is not looked at.
    virtual std::vector<char> from_first(std::vector<char> given) = 0;

    /// This rank cannot go on: the others are ended, or their calls throw. With MPI it does not return.
    /// @param code  with which the programs end
    virtual void give_up(int code) noexcept = 0;

    bool first() const { return rank() == 0; }
    bool alone() const { return size() == 1; }
};

/// What the first rank says.
bool as_the_first(Communicator& ranks, bool here);

/// The only rank.
std::unique_ptr<Communicator> alone();

/// Calls work(rank) on `count` threads, each of which is a rank, and returns when all have ended; throws what the first rank to
/// fail threw.
void in_one_process(int count, const std::function<void(Communicator&)>& work);

/// Whether the program was built with MPI.
bool built_with_mpi();

/// How many ranks this program was started with, as mpirun says in the environment; 1: by itself.
int started_ranks();

/// Which of them this is, as far as the environment says; 0: the first, or by itself.
int started_rank();

/// The ranks that were started together; alone() if this program was started by itself. Once in a program, on the thread that
/// ends it: MPI is ended with the object. @throws InputError if there are several, and the program was built without MPI
std::unique_ptr<Communicator> communicator_here();

}  // namespace feldspar
