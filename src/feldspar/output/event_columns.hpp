// What files tell of acoustic events: each column once, for CSV, HDF5 and ParaView.
#pragma once

#include <span>

#include "feldspar/methods/acoustic_event.hpp"

namespace feldspar {

struct EventColumn {
    const char* name;
    const char* unit;
    const char* meaning;
    double (*value)(const AcousticEvent&);
    bool whole = false;
};

std::span<const EventColumn> event_columns();

}  // namespace feldspar
