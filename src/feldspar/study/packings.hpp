// Specimens, each made once and shared by the runs on it.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "feldspar/specimen/specimen.hpp"

namespace feldspar {

/// What tells specimens apart: a hash of everything that defines one, and the seed. A file with a packing counts by its path.
std::string identity_of(const SpecimenSpec& spec, std::uint64_t seed);

/// Keeps the specimens used last. Any thread may ask; who asks first makes it, and others wait.
class Packings {
public:
    /// Told of the making of a specimen on the thread that makes it.
    using Tell = std::function<void(const SpecimenProgress&)>;

    /// @param kept  so many specimens stay when nobody uses them
    /// @param stop  if it becomes true, the making of a specimen ends; may be null
    Packings(std::size_t kept, const std::atomic<bool>* stop) : kept_(kept), stop_(stop) {}

    /// @throws what making it throws; Interrupted
    std::shared_ptr<const Specimen> get(const SpecimenSpec& spec, std::uint64_t seed, int threads, const Tell& tell = {});

private:
    using Made = std::shared_future<std::shared_ptr<const Specimen>>;

    std::size_t kept_;
    const std::atomic<bool>* stop_;
    std::mutex mutex_;
    std::map<std::string, Made> made_;  // by identity
    std::deque<std::string> used_;      // identities, the latest at the end
};

}  // namespace feldspar
