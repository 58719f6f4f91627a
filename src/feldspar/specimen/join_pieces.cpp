#include "feldspar/specimen/join_pieces.hpp"

namespace feldspar {
void join_pieces(CellGraph&, std::span<const Vec2>, const Outline&) {}
}  // namespace feldspar
