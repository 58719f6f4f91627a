#include "feldspar/base/thread_shares.hpp"

#include <algorithm>

namespace feldspar {

int share_for_next(int free, int places, int useful) { return std::clamp(free / std::max(places, 1), 1, std::max(useful, 1)); }

std::vector<int> shares_with(int free, std::span<const int> threads, std::span<const int> useful) {
    std::vector<int> shares(threads.begin(), threads.end());
    for (; free > 0; --free) {
        std::size_t poorest = shares.size();
        for (std::size_t i = 0; i < shares.size(); ++i)
            if (shares[i] < useful[i] && (poorest == shares.size() || shares[i] < shares[poorest])) poorest = i;
        if (poorest == shares.size()) break;
        ++shares[poorest];
    }
    return shares;
}

}  // namespace feldspar
