#include "feldspar/verify/topics.hpp"

namespace feldspar {

const std::vector<Topic>& all_topics() {
    static const std::vector<Topic> topics{
        {"Contact laws", contact_law_checks()},
        {"Dilation of joints", dilation_checks()},
        {"Triangles", triangle_checks()},
        {"Contacts", contact_checks()},
        {"Two grains", two_grain_checks()},
        {"Elastic specimens", specimen_checks()},
        {"Discs", disc_checks()},
        {"Bent beams", bending_checks()},
        {"Holes", hole_checks()},
        {"Toughness", toughness_checks()},
        {"Minerals and scatter", mixture_checks()},
        {"Joints", joint_checks()},
        {"Waves and stability", wave_checks()},
        {"Energy", energy_checks()},
        {"Statistics and fits", statistics_checks()},
    };
    return topics;
}

}  // namespace feldspar
