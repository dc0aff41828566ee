#include "algebra/elimination_order.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "algebra/kernel/front_kernel.h"

namespace virtual_work_dynamics {

namespace {

class Elimination {
 public:
  Elimination(const std::vector<RowBlock>& blocks, int columns)
      : blocks_(blocks), holders_(static_cast<std::size_t>(columns)), singles_(holders_.size()) {}

  std::vector<Front> run() {
    for (std::size_t b = 0; b < blocks_.size(); ++b) addToColumns(b);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      if (blocks_[b].columns.size() != 1) startWith(b);
    }
    for (int column = cheapest(); column >= 0; column = cheapest()) merge(column);
    return fronts_;
  }

 private:
  static std::size_t place(int column) { return static_cast<std::size_t>(column); }

  // Makes the front to come of a block a holder of its columns, before fronts exist.
  void addToColumns(std::size_t b) {
    const std::vector<int>& columns = blocks_[b].columns;
    if (columns.size() == 1) {
      singles_[place(columns.front())].push_back(b);
      return;
    }
    for (const int column : columns) holders_[place(column)].insert(fronts_to_come_);
    ++fronts_to_come_;
  }

  void startWith(std::size_t b) {
    Front front;
    front.blocks.push_back(b);
    finish(front, blocks_[b].columns);
  }

  // The column whose elimination couples the fewest columns; -1 when all are eliminated.
  int cheapest() const {
    int best = -1;
    std::size_t fewest = 0;
    for (std::size_t j = 0; j < holders_.size(); ++j) {
      if (eliminated_.count(static_cast<int>(j)) > 0) continue;
      const std::size_t coupled = coupledTo(static_cast<int>(j)).size();
      if (best >= 0 && coupled >= fewest) continue;
      best = static_cast<int>(j);
      fewest = coupled;
    }
    return best;
  }

  std::set<int> coupledTo(int column) const {
    std::set<int> columns{column};
    for (const std::size_t front : holders_[place(column)]) {
      columns.insert(fronts_[front].rest.begin(), fronts_[front].rest.end());
    }
    return columns;
  }

  void merge(int column) {
    const std::set<int> columns = coupledTo(column);
    Front front;
    front.children.assign(holders_[place(column)].begin(), holders_[place(column)].end());
    for (const std::size_t child : front.children) {
      for (const int other : fronts_[child].rest) holders_[place(other)].erase(child);
    }
    for (const int other : columns) holders_[place(other)].insert(fronts_.size());
    finish(front, std::vector<int>(columns.begin(), columns.end()));
  }

  // Divides the columns of a front into pivots, which only this front holds, and the rest.
  void finish(Front& front, const std::vector<int>& columns) {
    for (const int column : columns) {
      if (holders_[place(column)].size() > 1) {
        front.rest.push_back(column);
        continue;
      }
      front.pivots.push_back(column);
      eliminated_.insert(column);
      const std::vector<std::size_t>& singles = singles_[place(column)];
      front.blocks.insert(front.blocks.end(), singles.begin(), singles.end());
    }
    fronts_.push_back(std::move(front));
  }

  const std::vector<RowBlock>& blocks_;
  std::vector<std::set<std::size_t>> holders_;     // fronts that have the column, for each column
  std::vector<std::vector<std::size_t>> singles_;  // blocks of the column alone, for each column
  std::size_t fronts_to_come_ = 0;
  std::set<int> eliminated_;
  std::vector<Front> fronts_;
};

// Instructions of one matrix, counted in those that the package runs on: what a front and a
// reflection cost whatever their size, and a reflection of another column, without and for each
// chunk of its rows.
constexpr std::size_t kOfFront = 60, kOfReflection = 35, kOfColumn = 8, kOfChunk = 6;
// One front must cost less than so many tenths of what others do.
constexpr std::size_t kClearlyLess = 8;

std::size_t rowsOf(const std::vector<RowBlock>& blocks, const std::vector<std::size_t>& of) {
  return std::accumulate(of.begin(), of.end(), std::size_t{0}, [&](std::size_t sum, std::size_t b) {
    return sum + static_cast<std::size_t>(blocks[b].rows) - blocks[b].zeros.size();
  });
}

std::size_t costOf(std::size_t rows, std::size_t width, std::size_t steps) {
  const std::size_t chunks = (rows + kRowChunk - 1) / kRowChunk;
  std::size_t cost = kOfFront + steps * kOfReflection;
  for (std::size_t step = 1; step <= std::min(steps, width); ++step) {
    cost += (width - step) * (kOfColumn + kOfChunk * chunks);
  }
  return cost;
}

std::size_t costOf(const std::vector<RowBlock>& blocks, const std::vector<Front>& fronts) {
  std::size_t cost = 0;
  std::vector<std::size_t> remaining;  // rows, by front
  for (const Front& front : fronts) {
    std::size_t rows = rowsOf(blocks, front.blocks);
    for (const std::size_t child : front.children) rows += remaining[child];
    const std::size_t width = front.pivots.size() + front.rest.size();
    const std::size_t steps = std::min(rows, width);
    remaining.push_back(steps - std::min(steps, front.pivots.size()));
    cost += costOf(rows, width, steps);
  }
  return cost;
}

Front wholeFront(const std::vector<RowBlock>& blocks, int columns) {
  Front front;
  front.pivots.resize(static_cast<std::size_t>(columns));
  std::iota(front.pivots.begin(), front.pivots.end(), 0);
  front.blocks.resize(blocks.size());
  std::iota(front.blocks.begin(), front.blocks.end(), std::size_t{0});
  return front;
}

}  // namespace

std::vector<Front> eliminationOrder(const std::vector<RowBlock>& blocks, int columns) {
  std::vector<Front> fronts = Elimination(blocks, columns).run();
  std::vector<Front> one{wholeFront(blocks, columns)};
  return 10 * costOf(blocks, one) < kClearlyLess * costOf(blocks, fronts) ? one : fronts;
}

}  // namespace virtual_work_dynamics
