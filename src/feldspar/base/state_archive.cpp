#include "feldspar/base/state_archive.hpp"

#include <algorithm>

namespace feldspar {
namespace {

// How a column stands in the file.
enum class Stands : unsigned char {
    here,       // its bytes follow
    as_base,    // as in the base state, with this checksum
    as_before,  // as the column with this number
    zeros,
    sparse  // words of 8 bytes: a bit for each, whether it is zero, then those that are not; then what is left of a word
};

constexpr std::size_t kSmall = 64;  // bytes: shorter columns just stand there

// Words of 8 bytes of a column, and which of them are not zero.
struct Words {
    std::vector<std::uint64_t> bits, words;
    std::size_t count = 0;

    Words(const char* data, std::size_t bytes) : bits((bytes / 8 + 63) / 64), count(bytes / 8) {
        for (std::size_t i = 0; i < count; ++i) {
            std::uint64_t word = 0;
            std::memcpy(&word, data + 8 * i, 8);
            if (word == 0) continue;
            bits[i / 64] |= std::uint64_t{1} << i % 64;
            words.push_back(word);
        }
    }
};

// Whether so many words are zero that it pays to leave them out: looked at in every 16th place.
bool mostly_zero(const char* data, std::size_t bytes) {
    std::size_t zero = 0, looked = 0;
    for (std::size_t i = 0; i + 8 <= bytes; i += 128, ++looked) {
        std::uint64_t word = 0;
        std::memcpy(&word, data + i, 8);
        zero += word == 0;
    }
    return 4 * zero > looked;
}

bool all_zero(const char* data, std::size_t bytes) {
    return std::all_of(data, data + bytes, [](char byte) { return byte == 0; });
}

}  // namespace

void StateWriter::count(std::size_t& count) {
    const std::uint64_t value = count;
    put_(&value, sizeof value);
}

void StateWriter::column(const char* data, std::size_t bytes) {
    if (bytes == 0) return;
    const auto stands = [&](Stands how) { put_(&how, sizeof how); };
    if (bytes <= kSmall) {
        stands(Stands::here);
        put_(data, bytes);
        return;
    }
    const std::uint64_t hash = hash_of_bytes(data, bytes);
    if (base_.has(path(), bytes, hash)) {
        stands(Stands::as_base);
        put_(&hash, sizeof hash);
        return;
    }
    if (all_zero(data, bytes)) return stands(Stands::zeros);
    const auto [known, is_new] = written_.try_emplace({bytes, hash}, written_.size());
    if (!is_new) {
        stands(Stands::as_before);
        put_(&known->second, sizeof known->second);
        return;
    }
    if (mostly_zero(data, bytes)) {
        const Words sparse(data, bytes);
        const std::uint64_t words = sparse.words.size();
        stands(Stands::sparse);
        put_(&words, sizeof words);
        put_(sparse.bits.data(), 8 * sparse.bits.size());
        put_(sparse.words.data(), 8 * sparse.words.size());
        put_(data + 8 * sparse.count, bytes - 8 * sparse.count);
        return;
    }
    stands(Stands::here);
    put_(data, bytes);
}

std::size_t StateWriter::number_of(const void* object) {
    if (object == nullptr) return 0;
    return objects_.try_emplace(object, objects_.size() + 1).first->second;
}

bool StateWriter::is_new(std::size_t number) {
    if (number <= objects_seen_) return false;
    objects_seen_ = number;
    return true;
}

std::span<const char> StateReader::next(std::size_t count) {
    if (count > data_.size() - at_) throw StateError("it ends too early");
    const std::span<const char> found = data_.subspan(at_, count);
    at_ += count;
    return found;
}

void StateReader::bytes(void* data, std::size_t count) {
    const std::span<const char> found = next(count);
    std::copy(found.begin(), found.end(), static_cast<char*>(data));
}

void StateReader::count(std::size_t& count) {
    std::uint64_t value = 0;
    bytes(&value, sizeof value);
    count = value;
}

void StateReader::column(char* data, std::size_t bytes_of_it) {
    if (bytes_of_it == 0) return;
    Stands how{};
    bytes(&how, sizeof how);
    switch (how) {
        case Stands::here: {
            const std::span<const char> column = next(bytes_of_it);
            std::copy(column.begin(), column.end(), data);
            if (bytes_of_it > kSmall) columns_.push_back(column);
            return;
        }
        case Stands::as_base: {
            std::uint64_t hash = 0;
            bytes(&hash, sizeof hash);
            if (hash_of_bytes(data, bytes_of_it) != hash)
                throw StateError("it is of another specimen, or of another version of the program");
            return;
        }
        case Stands::as_before: {
            std::uint64_t number = 0;
            bytes(&number, sizeof number);
            if (number >= columns_.size() || columns_[number].size() != bytes_of_it)
                throw StateError("a part refers to one that is not there");
            std::copy(columns_[number].begin(), columns_[number].end(), data);
            return;
        }
        case Stands::zeros:
            std::fill(data, data + bytes_of_it, char{});
            return;
        case Stands::sparse: {
            std::uint64_t words = 0;
            bytes(&words, sizeof words);
            const std::size_t count = bytes_of_it / 8;
            if (words > count) throw StateError("a part has more words than there is room for");
            std::vector<std::uint64_t> bits((count + 63) / 64);
            bytes(bits.data(), 8 * bits.size());
            std::span<const char> given = next(8 * words);
            std::fill(data, data + bytes_of_it, char{});
            for (std::size_t i = 0; i < count; ++i) {
                if ((bits[i / 64] >> i % 64 & 1U) == 0) continue;
                if (given.empty()) throw StateError("a part has too few words");
                std::copy_n(given.begin(), 8, data + 8 * i);
                given = given.subspan(8);
            }
            if (!given.empty()) throw StateError("a part has too many words");
            bytes(data + 8 * count, bytes_of_it - 8 * count);
            unpacked_.emplace_back(data, data + bytes_of_it);
            columns_.emplace_back(unpacked_.back());
            return;
        }
    }
    throw StateError("a part begins with a mark that is none");
}

void StateReader::learn(std::size_t number, std::shared_ptr<const void> object) {
    if (number != objects_.size() + 1) throw StateError("an object stands in the wrong place");
    objects_.push_back(std::move(object));
}

}  // namespace feldspar
