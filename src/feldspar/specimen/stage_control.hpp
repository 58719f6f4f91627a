// What a stage of the making of a specimen works with, apart from its input. None of it changes what comes out.
#pragma once

#include <functional>

#include "feldspar/base/parallel.hpp"

namespace feldspar {

/// Threads and a listener for one stage.
struct StageControl {
    Team* team = nullptr;  ///< to share the work with; none: the caller's thread alone
    std::function<void(double share)>
        tell;  ///< hears the share done, 0 to 1, now and then; may be empty; may throw to end the work

    /// Tells that `share` of the stage, 0 to 1, is done.
    void done(double share) const {
        if (tell) tell(share);
    }
};

}  // namespace feldspar
