// Writes down what a test does: history rows, cracks, fields. It only reads the body.
#pragma once

#include <memory>
#include <vector>

#include "feldspar/lab/experiment.hpp"
#include "feldspar/lab/rate_control.hpp"
#include "feldspar/methods/result.hpp"

namespace feldspar {

class Recorder {
public:
    explicit Recorder(const Experiment& experiment, TestResult& result);

    /// Rows of the phase that was passed over in closed form, from `from` (stress and strain) to the present state.
    void elastic_phase(const HistoryRow& from);

    /// A row of the present state; collects new cracks and keeps snapshots as they fall due.
    const HistoryRow& record(Phase phase);

    /// What was unbalanced in the state of the last row.
    const Unbalanced& unbalanced() const { return now_.unbalanced; }

    /// Where a record stands, to go back to.
    struct Mark;
    Mark mark() const;
    void go_back_to(const Mark& mark);

    template <class Archive>
    void keep(Archive& archive) {
        auto& [experiment, result, now] = *this;
        archive(now);
    }

    /// Puts the snapshots in order and adds the end and the peak. @param last_row  the last row of the history
    void finish();

private:
    struct Fields {  // what a snapshot needs, copied cheaply; stresses are computed at the end
        std::string label;
        HistoryRow row;
        Array<Vec2> displacement;                                          // a node of the assembly
        std::vector<Mat2> grain_stress;                                    // a grain, unless grains have triangles of their own
        std::vector<float> damage;                                         // a contact point
        std::vector<double> opening;                                       // a contact point
        std::vector<float> contact_damage, contact_normal, contact_shear;  // a contact that bonded two grains before the test
        int cracks = 0;
    };
    HistoryRow present(Phase phase);
    Fields fields(const std::string& label, const HistoryRow& row) const;
    Snapshot complete(const Fields& fields) const;
    void collect_cracks();
    bool joins_grains(const Contact& contact) const;
    void name_grain_contacts();
    void keep_snapshots(const HistoryRow& row);
    int strength_sign() const { return e_.direction < 0.0 ? -1 : 1; }

    using Kept = std::shared_ptr<const Fields>;
    struct State {                         // everything that recording changes here
        long long cracks_seen_until = -1;  // step
        std::vector<int> crack_points;     // contact point of each crack
        std::vector<Kept> loading;         // evenly spaced in cracks, thinned out as their number grows
        int crack_spacing = 1;
        int next_cracks = 0;
        Kept start, first_crack, peak;  // may be empty
        int tensile = 0, shear = 0;
        Unbalanced unbalanced;
    };

    const Experiment& e_;
    TestResult& result_;
    State now_;
};

struct Recorder::Mark {
    State state;
    std::size_t rows = 0, cracks = 0;  // of the result
};

}  // namespace feldspar
