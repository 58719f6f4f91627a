#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "feldspar/ranks/communicator.hpp"

namespace feldspar {
namespace {

// Where messages wait, in the order in which they were sent, from each rank to each.
class Post {
public:
    explicit Post(int ranks) : ranks_(static_cast<std::size_t>(ranks)), waiting_(ranks_ * ranks_) {}

    void send(int from, int to, std::span<const char> message) {
        const std::lock_guard lock(mutex_);
        waiting_[place(from, to)].emplace_back(message.begin(), message.end());
        arrived_.notify_all();
    }

    std::vector<char> receive(int from, int to) {
        std::unique_lock lock(mutex_);
        std::deque<std::vector<char>>& queue = waiting_[place(from, to)];
        arrived_.wait(lock, [&] { return !queue.empty() || lost_; });
        if (queue.empty()) throw RankLost("another rank has given up");
        std::vector<char> message = std::move(queue.front());
        queue.pop_front();
        return message;
    }

    void lose() {
        const std::lock_guard lock(mutex_);
        lost_ = true;
        arrived_.notify_all();
    }

private:
    std::size_t place(int from, int to) const { return static_cast<std::size_t>(from) * ranks_ + static_cast<std::size_t>(to); }

    std::size_t ranks_;
    std::mutex mutex_;
    std::condition_variable arrived_;
    std::vector<std::deque<std::vector<char>>> waiting_;
    bool lost_ = false;
};

class Thread final : public Communicator {
public:
    Thread(Post& post, int rank, int size) : post_(post), rank_(rank), size_(size) {}

    int rank() const override { return rank_; }
    int size() const override { return size_; }
    int on_this_machine() const override { return size_; }

    void exchange(std::span<const Transfer> transfers) override {
        for (const Transfer& transfer : transfers) post_.send(rank_, transfer.other, transfer.out);
        for (const Transfer& transfer : transfers) {
            const std::vector<char> message = post_.receive(transfer.other, rank_);
            if (message.size() != transfer.in.size()) throw RankLost("a rank has sent something else than was expected");
            if (!message.empty()) std::memcpy(transfer.in.data(), message.data(), message.size());
        }
    }

    void gather(std::span<const char> own, Gathered& all) override {
        for (int other = 0; other < size_; ++other)
            if (other != rank_) post_.send(rank_, other, own);
        all.bytes.clear();
        std::vector<std::size_t> bytes;
        for (int other = 0; other < size_; ++other) {
            const std::vector<char> part =
                other == rank_ ? std::vector<char>(own.begin(), own.end()) : post_.receive(other, rank_);
            all.bytes.insert(all.bytes.end(), part.begin(), part.end());
            bytes.push_back(part.size());
        }
        all.of_rank.clear();
        const char* at = all.bytes.data();
        for (const std::size_t of_one : bytes) {
            all.of_rank.emplace_back(at, of_one);
            at += of_one;
        }
    }

    std::vector<char> from_first(std::vector<char> given) override {
        if (rank_ > 0) return post_.receive(0, rank_);
        for (int other = 1; other < size_; ++other) post_.send(0, other, given);
        return given;
    }

    void give_up(int) noexcept override { post_.lose(); }

private:
    Post& post_;
    int rank_, size_;
};

}  // namespace

bool as_the_first(Communicator& ranks, bool here) { return ranks.from_first({static_cast<char>(here)}).at(0) != 0; }

std::unique_ptr<Communicator> alone() {
    class Alone final : public Communicator {
    public:
        int rank() const override { return 0; }
        int size() const override { return 1; }
        int on_this_machine() const override { return 1; }
        void exchange(std::span<const Transfer>) override {}
        void gather(std::span<const char> own, Gathered& all) override {
            all.bytes.assign(own.begin(), own.end());
            all.of_rank = {all.bytes};
        }
        std::vector<char> from_first(std::vector<char> given) override { return given; }
        void give_up(int) noexcept override {}
    };
    return std::make_unique<Alone>();
}

void in_one_process(int count, const std::function<void(Communicator&)>& work) {
    Post post(count);
    std::mutex mutex;
    std::exception_ptr thrown;  // by the first to fail: what others throw follows from it
    {
        std::vector<std::jthread> threads;
        for (int rank = 0; rank < count; ++rank)
            threads.emplace_back([&, rank] {
                Thread communicator(post, rank, count);
                try {
                    work(communicator);
                } catch (...) {
                    {
                        const std::lock_guard lock(mutex);
                        if (!thrown) thrown = std::current_exception();
                    }
                    communicator.give_up(1);
                }
            });
    }
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace feldspar
