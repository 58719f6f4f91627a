#include "feldspar/ranks/ranked_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <exception>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "feldspar/base/error.hpp"
#include "feldspar/base/running_hash.hpp"
#include "feldspar/base/stopwatch.hpp"
#include "feldspar/model/state_hash.hpp"
#include "feldspar/ranks/share.hpp"
#include "feldspar/step/advance_packs.hpp"

namespace feldspar {
namespace {

using Clock = std::chrono::steady_clock;

// Into memory that stays from one time to the next.
class Writer {
public:
    explicit Writer(std::vector<char>& bytes) : bytes_(bytes) {}
    template <class T>
    void put(const T* from, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::size_t bytes = sizeof(T) * count;
        if (bytes > bytes_.size() - at_) bytes_.resize(2 * bytes_.size() + bytes);
        if (bytes > 0) std::memcpy(bytes_.data() + at_, from, bytes);
        at_ += bytes;
    }
    template <class T>
    void put(const T& value) {
        put(&value, 1);
    }
    std::span<const char> written() const { return {bytes_.data(), at_}; }

private:
    std::vector<char>& bytes_;
    std::size_t at_ = 0;
};

class Reader {
public:
    explicit Reader(std::span<const char> bytes) : bytes_(bytes) {}
    template <class T>
    void take(T* to, std::size_t count) {
        const std::size_t bytes = sizeof(T) * count;
        if (bytes > bytes_.size()) throw RankLost("a rank has left less than was expected");
        if (bytes > 0) std::memcpy(to, bytes_.data(), bytes);
        bytes_ = bytes_.subspan(bytes);
    }
    template <class T>
    void take(T& value) {
        take(&value, 1);
    }
    bool at_end() const { return bytes_.empty(); }

private:
    std::span<const char> bytes_;
};

// What a point of a contact keeps that all have, and what only damaged ones change.
constexpr Array<double> Bonds::*kOfAll[] = {&Bonds::un_m, &Bonds::us_m, &Bonds::Fn_N, &Bonds::Fs_N};
constexpr Array<double> Bonds::*kOfDamaged[] = {&Bonds::max_un_m, &Bonds::max_us_m, &Bonds::damage, &Bonds::fracture_J,
                                                &Bonds::friction_J};

// A point that broke within the block.
struct Break {
    std::int32_t point = 0;
    std::uint8_t in_tension = 0, lost_compression = 0;
    long long step = 0;
    double broken_J = 0.0;
};

// What the share of work follows from, as it was when it was made.
struct Seen {
    struct Pack {
        std::int32_t first_contact, lanes, active;
        bool operator==(const Pack&) const = default;
    };
    std::vector<Pack> packs;
    std::vector<std::int32_t> loose_contacts, loose_bodies;
    std::vector<std::uint32_t> line_a, line_b;

    explicit Seen(const Packs& all)
        : loose_contacts(all.loose_contacts),
          loose_bodies(all.loose_bodies),
          line_a(all.line_a.begin(), all.line_a.end()),
          line_b(all.line_b.begin(), all.line_b.end()) {
        for (const ContactPack& pack : all.contacts) packs.push_back({pack.first_contact, pack.lanes, pack.active});
    }
    bool still_holds(const Packs& all) const {
        if (packs.size() != all.contacts.size() || loose_contacts != all.loose_contacts || loose_bodies != all.loose_bodies ||
            !std::equal(line_a.begin(), line_a.end(), all.line_a.begin(), all.line_a.end()) ||
            !std::equal(line_b.begin(), line_b.end(), all.line_b.begin(), all.line_b.end()))
            return false;
        for (std::size_t p = 0; p < packs.size(); ++p)
            if (packs[p] != Pack{all.contacts[p].first_contact, all.contacts[p].lanes, all.contacts[p].active}) return false;
        return true;
    }
};

class RankedSteps final : public StepDevice {
public:
    RankedSteps(Communicator& ranks, RankTraffic* traffic)
        : ranks_(ranks), traffic_(traffic != nullptr ? *traffic : own_traffic_) {}

    void advance(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count,
                 PlatenWork& work) override {
        if (count <= 0) return;
        if (settings.kernels == nullptr) throw InputError({}, "ranks make steps by the kernels of packs only");
        const Clock::time_point start = Clock::now();
        agree(assembly, settings, first_step, count);
        sort_out_packs(assembly);
        share_out(assembly);
        make_steps(assembly, team, settings, first_step, count);
        const Clock::time_point behind = Clock::now();
        const std::span<const char> left = leave(assembly, first_step);
        ranks_.gather(left, all_);
        take(assembly, count);
        add_up_work(assembly, settings, count, work);
        traffic_.gather_s += seconds_since(behind);
        traffic_.all_s += seconds_since(start);
        traffic_.bytes_in_blocks += static_cast<double>(left.size());
        traffic_.steps += count;
        ++traffic_.blocks;
    }

private:
    // That all ranks are about to do the same; the first time, to the same thing.
    void agree(const Assembly& assembly, const StepSettings& settings, long long first_step, int count) {
        RunningHash hash;
        const auto add = [&hash](const auto& value) { hash.add(&value, sizeof value); };
        add(settings.dt);
        add(settings.damping);
        add(settings.alpha);
        add(settings.viscous);
        add(settings.strength);
        add(settings.speed);
        add(first_step);
        add(count);
        add(assembly.contacts.size());
        add(assembly.points.size());
        for (const DeadLoad& load : assembly.dead_loads) add(load.pressure_Pa);
        for (const Fixture& fixture : assembly.fixtures) add(fixture.motion);
        if (std::exchange(first_, false)) {
            const StateHash state = hash_state(assembly);
            add(state);
            const auto add_all = [&hash](const auto& array) { hash.add(array.data(), array.size() * sizeof(array[0])); };
            add_all(assembly.nodes.reference);
            add_all(assembly.nodes.inverse_mass);
            add_all(assembly.nodes.loading_mode);
            add_all(assembly.packs.line_a);
            add_all(assembly.packs.line_b);
            add_all(assembly.packs.area);
        }
        const std::uint64_t own = hash.digest();
        ranks_.gather({reinterpret_cast<const char*>(&own), sizeof own}, all_);
        for (std::size_t other = 0; other < all_.of_rank.size(); ++other)
            if (std::memcmp(all_.of_rank[other].data(), all_.of_rank[0].data(), sizeof own) != 0)
                throw NumericalError(fmt::format(
                    "rank {} of {} has come to other numbers than the first one by step {}: machines whose processors or "
                    "system libraries differ cannot make a test together (FELDSPAR_KERNELS chooses vector instructions "
                    "that all have)",
                    other, ranks_.size(), first_step));
    }

    void share_out(const Assembly& assembly) {
        if (seen_ && seen_->still_holds(assembly.packs)) return;
        const Clock::time_point start = Clock::now();
        if (units_to_share(assembly) < ranks_.size())
            throw InputError({.key = "mpirun"},
                             fmt::format("the specimen has {} packs of grains, or rigid bodies, too few for {} ranks",
                                         units_to_share(assembly), ranks_.size()),
                             "fewer ranks, or a larger specimen");
        share_ = share_of_rank(assembly, ranks_.rank(), ranks_.size());
        seen_.emplace(assembly.packs);
        out_.resize(share_.borders.size());
        in_.resize(share_.borders.size());
        transfers_.clear();
        for (std::size_t i = 0; i < share_.borders.size(); ++i) {
            const Border& border = share_.borders[i];
            const auto bytes = [](const auto& lines, const auto& nodes) {
                return sizeof(SideLine) * lines.size() + 2 * sizeof(Vec2) * nodes.size();
            };
            out_[i].resize(bytes(border.lines_out, border.nodes_out));
            in_[i].resize(bytes(border.lines_in, border.nodes_in));
            transfers_.push_back({border.other, out_[i], in_[i]});
        }
        // Nodes of the loading, in the order in which their forces are added, and of which rank each is.
        std::vector<std::int32_t> rank_of(assembly.nodes.force.size(), 0);
        for (std::size_t r = 0; r < share_.parts.size(); ++r)
            for (const IndexRange range : share_.parts[r].nodes)
                std::fill(rank_of.begin() + range.begin, rank_of.begin() + range.end, static_cast<std::int32_t>(r));
        loading_nodes_.assign(share_.parts.size(), {});
        for (const Fixture& fixture : assembly.fixtures)
            for (const int node : fixture.moves() ? fixture.nodes : std::vector<std::int32_t>{})
                loading_nodes_[static_cast<std::size_t>(rank_of[static_cast<std::size_t>(node)])].push_back(node);
        std::size_t points = 0;
        for (const int p : share_.contact_packs) {
            const ContactPack& pack = assembly.packs.contacts[static_cast<std::size_t>(p)];
            points += static_cast<std::size_t>(pack.lanes * pack.points);
        }
        traffic_.own_part = static_cast<double>(points) / static_cast<double>(assembly.points.size());
        traffic_.share_s += seconds_since(start);
    }

    const OwnPart& own() const { return share_.parts[static_cast<std::size_t>(ranks_.rank())]; }

    void make_steps(Assembly& assembly, Team& team, const StepSettings& settings, long long first_step, int count) {
        const KernelArrays arrays(assembly);
        const PackStages stages(assembly, settings, arrays);
        loading_forces_.clear();
        std::exception_ptr lost;
        std::atomic<bool> over{false};
        team.run([&](int thread) {
            KernelStep step = kernel_step(settings);
            const auto part = [&](IndexRange range) {
                const IndexRange share = team.share(range.end - range.begin, thread);
                return IndexRange{range.begin + share.begin, range.begin + share.end};
            };
            const auto share_of = [&](const std::vector<std::int32_t>& list) {
                const IndexRange share = team.share(static_cast<int>(list.size()), thread);
                return std::span(list).subspan(static_cast<std::size_t>(share.begin),
                                               static_cast<std::size_t>(share.end - share.begin));
            };
            const PackRanges bodies{{}, {}, part(own().grains), part(own().rigid), {}};
            const std::span<const std::int32_t> packs = share_of(share_.contact_packs), loose = share_of(share_.loose_contacts),
                                                loose_bodies = share_of(own().loose_bodies);
            stages.lines(bodies);
            for (const int b : loose_bodies) stages.lines_of_loose(b);
            for (int k = 0; k < count; ++k) {
                team.barrier();
                if (thread == 0) {
                    if (k > 0) note_loading(assembly);
                    try {
                        exchange(assembly);
                    } catch (...) {  // the team does not throw
                        lost = std::current_exception();
                        over = true;
                    }
                }
                team.barrier();
                if (over) return;
                step.step = first_step + k;
                step.keep_forces = k + 1 == count;
                for (std::size_t i = 0; i < packs.size();) {  // packs that follow each other go together
                    std::size_t end = i + 1;
                    while (end < packs.size() && packs[end] == packs[end - 1] + 1) ++end;
                    stages.contacts(step, {{packs[i], packs[end - 1] + 1}, {}, {}, {}, {}});
                    i = end;
                }
                for (const int c : loose) stages.loose_contact(step, c);
                team.barrier();
                stages.bodies(step, bodies);
                for (const int b : loose_bodies) stages.loose_body(b);
            }
        });
        if (lost) std::rethrow_exception(lost);
        note_loading(assembly);
    }

    // What the own nodes of the loading feel, before the next step.
    void note_loading(const Assembly& assembly) {
        for (const int node : loading_nodes_[static_cast<std::size_t>(ranks_.rank())])
            loading_forces_.push_back(assembly.nodes.force[node]);
    }

    // Tells the other ranks how the bodies move that their contacts look at.
    void exchange(Assembly& s) {
        if (transfers_.empty()) return;
        const Clock::time_point start = Clock::now();
        Array<SideLine>& lines = s.packs.lines;
        Nodes& nodes = s.nodes;
        for (std::size_t i = 0; i < share_.borders.size(); ++i) {
            char* to = out_[i].data();
            const auto put = [&to](const auto& value) {
                std::memcpy(to, &value, sizeof value);
                to += sizeof value;
            };
            for (const int line : share_.borders[i].lines_out) put(lines[line].field);
            for (const int node : share_.borders[i].nodes_out) {
                put(nodes.displacement[node]);
                put(nodes.velocity[node]);
            }
            traffic_.bytes_in_steps += static_cast<double>(out_[i].size());
        }
        ranks_.exchange(transfers_);
        for (std::size_t i = 0; i < share_.borders.size(); ++i) {
            const char* from = in_[i].data();
            const auto take = [&from](auto& value) {
                std::memcpy(&value, from, sizeof value);
                from += sizeof value;
            };
            for (const int line : share_.borders[i].lines_in) take(lines[line].field);
            for (const int node : share_.borders[i].nodes_in) {
                take(nodes.displacement[node]);
                take(nodes.velocity[node]);
            }
        }
        traffic_.exchange_s += seconds_since(start);
    }

    // What is known of a point of a contact in no pack.
    struct LoosePoint {
        std::int32_t point = 0;
        bool dilates = false;
        BondState bond{};
        double slip_m = 0.0;
    };

    static LoosePoint known(const Assembly& s, int point, bool dilates) {
        return {point, dilates, s.bond(point), dilates ? s.bonds.slip_m[s.points[point].state] : 0.0};
    }

    // Calls visit(point, whether it dilates).
    template <class Visit>
    static void for_each_loose_point(const Assembly& s, const OwnPart& part, Visit visit) {
        for (const int c : part.loose_contacts) {
            const Contact& contact = s.contacts[c];
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p) visit(p, contact.dilation >= 0);
        }
    }

    // What this rank has changed of its part, for the others; take() reads it in the same order.
    std::span<const char> leave(const Assembly& s, long long first_step) {
        Writer out(left_);
        for (const IndexRange n : own().nodes)
            for (const auto* quantity : {&s.nodes.displacement, &s.nodes.velocity, &s.nodes.force})
                out.put(quantity->data() + n.begin, static_cast<std::size_t>(n.end - n.begin));
        for (const int b : own().bodies) out.put(s.body_work[b]);
        breaks_.clear();
        const auto note_breaks = [&](const Contact& contact) {
            for (int p = contact.first_point; p < contact.first_point + contact.points; ++p)
                if (const ContactPoint& point = s.points[p]; point.broken_step >= first_step)
                    breaks_.push_back({p, point.broke_in_tension, point.lost_compression, point.broken_step, point.broken_J});
        };
        for (const int p : own().contact_packs) {
            const ContactPack& pack = s.packs.contacts[p];
            const auto points = static_cast<std::size_t>(pack.lanes * pack.points);
            for (const auto quantity : kOfAll) out.put((s.bonds.*quantity).data() + pack.first_state, points);
            const bool untouched = pack.plain && pack.intact;  // the kernels clear `intact` of plain packs only
            out.put(untouched);
            if (untouched) continue;
            for (const auto quantity : kOfDamaged) out.put((s.bonds.*quantity).data() + pack.first_state, points);
            for (int c = pack.first_contact; c < pack.first_contact + pack.lanes; ++c) note_breaks(s.contacts[c]);
        }
        for (const int c : own().loose_contacts) {
            out.put(&s.slots[2 * c], 2);
            note_breaks(s.contacts[c]);
        }
        for_each_loose_point(s, own(), [&](int p, bool dilates) { out.put(known(s, p, dilates)); });
        out.put(breaks_.size());
        out.put(breaks_.data(), breaks_.size());
        out.put(loading_forces_.data(), loading_forces_.size());
        return out.written();
    }

    // What the others have changed of theirs.
    void take(Assembly& s, int count) {
        // Loose contacts stand in packs whose other lanes may be another rank's, which leaves what it knows of them.
        loose_.clear();
        for_each_loose_point(s, own(), [&](int p, bool dilates) { loose_.push_back(known(s, p, dilates)); });
        forces_of_ranks_.resize(share_.parts.size());
        for (int rank = 0; rank < ranks_.size(); ++rank) {
            const auto r = static_cast<std::size_t>(rank);
            std::vector<Vec2>& forces = forces_of_ranks_[r];
            forces.resize(static_cast<std::size_t>(count) * loading_nodes_[r].size());
            if (rank == ranks_.rank()) {
                forces = loading_forces_;
                continue;
            }
            const OwnPart& part = share_.parts[r];
            Reader in(all_.of_rank[r]);
            for (const IndexRange n : part.nodes)
                for (auto* quantity : {&s.nodes.displacement, &s.nodes.velocity, &s.nodes.force})
                    in.take(quantity->data() + n.begin, static_cast<std::size_t>(n.end - n.begin));
            for (const int b : part.bodies) in.take(s.body_work[b]);
            for (const int p : part.contact_packs) {
                const ContactPack& pack = s.packs.contacts[p];
                const auto points = static_cast<std::size_t>(pack.lanes * pack.points);
                for (const auto quantity : kOfAll) in.take((s.bonds.*quantity).data() + pack.first_state, points);
                bool untouched = false;
                in.take(untouched);
                if (untouched) continue;
                for (const auto quantity : kOfDamaged) in.take((s.bonds.*quantity).data() + pack.first_state, points);
            }
            for (const int c : part.loose_contacts) in.take(&s.slots[2 * c], 2);
            for_each_loose_point(s, part, [&](int, bool) { in.take(loose_.emplace_back()); });
            std::size_t breaks = 0;
            in.take(breaks);
            breaks_.resize(breaks);
            in.take(breaks_.data(), breaks);
            for (const Break& b : breaks_) {
                ContactPoint& point = s.points[b.point];
                point.broken_step = b.step;
                point.broke_in_tension = b.in_tension != 0;
                point.lost_compression = b.lost_compression != 0;
                point.broken_J = b.broken_J;
            }
            in.take(forces.data(), forces.size());
            if (!in.at_end()) throw RankLost("a rank has left more than was expected");
        }
        for (const LoosePoint& loose : loose_) {
            s.set_bond(loose.point, loose.bond);
            if (loose.dilates) s.bonds.slip_m[s.points[loose.point].state] = loose.slip_m;
        }
    }

    // In the order of steps and nodes in which a program that is alone adds them.
    void add_up_work(Assembly& s, const StepSettings& settings, int count, PlatenWork& work) const {
        const double travel = settings.dt * settings.speed;
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
            for (std::size_t r = 0; r < loading_nodes_.size(); ++r) {
                const std::vector<std::int32_t>& nodes = loading_nodes_[r];
                for (std::size_t i = 0; i < nodes.size(); ++i)
                    s.nodes.force[nodes[i]] = forces_of_ranks_[r][k * nodes.size() + i];
            }
            work.loading += loading_reaction(s) * travel;
        }
    }

    Communicator& ranks_;
    RankTraffic own_traffic_;
    RankTraffic& traffic_;
    bool first_ = true;
    std::optional<Seen> seen_;
    Share share_;
    std::vector<std::vector<char>> out_, in_;  // of each border
    std::vector<Transfer> transfers_;
    std::vector<std::vector<std::int32_t>> loading_nodes_;  // of each rank
    std::vector<Vec2> loading_forces_;                      // on this rank's, step by step
    std::vector<std::vector<Vec2>> forces_of_ranks_;
    std::vector<Break> breaks_;
    std::vector<LoosePoint> loose_;
    std::vector<char> left_;
    Gathered all_;
};

}  // namespace

std::unique_ptr<StepDevice> open_ranks(Communicator& ranks, RankTraffic* traffic) {
    return std::make_unique<RankedSteps>(ranks, traffic);
}

}  // namespace feldspar
