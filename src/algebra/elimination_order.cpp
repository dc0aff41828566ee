#include "algebra/elimination_order.h"

#include <algorithm>
#include <set>

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

}  // namespace

std::vector<Front> eliminationOrder(const std::vector<RowBlock>& blocks, int columns) {
  return Elimination(blocks, columns).run();
}

}  // namespace virtual_work_dynamics
