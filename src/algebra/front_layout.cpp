#include "algebra/front_layout.h"

#include <algorithm>

namespace virtual_work_dynamics {

namespace {

template <typename Item>
int count(const std::vector<Item>& list) {
  return static_cast<int>(list.size());
}

}  // namespace

FrontLayout::FrontLayout(const std::vector<RowBlock>& blocks, int columns)
    : blocks_(blocks),
      fronts_(eliminationOrder(blocks, columns)),
      present_(static_cast<std::size_t>(columns), true),
      local_(static_cast<std::size_t>(columns)) {
  int rows = 0;
  for (const RowBlock& block : blocks_) {
    first_.push_back(rows);
    rows += static_cast<int>(block.rows);
  }
  first_.push_back(rows);
  for (const RowBlock& block : blocks_) {
    orders_.push_back(count(row_order_));
    const auto isZero = [&](int i) {
      return std::binary_search(block.zeros.begin(), block.zeros.end(), i);
    };
    for (const bool zero : {false, true}) {
      for (int i = 0; i < static_cast<int>(block.rows); ++i) {
        if (isZero(i) == zero) row_order_.push_back(i);
      }
      if (!zero) kept_.push_back(count(row_order_) - orders_.back());
    }
  }
  places_of_rows_.assign(static_cast<std::size_t>(rows), {-1, 0});
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    int row = 0;
    for (const std::size_t b : fronts_[f].blocks) {
      for (int i = 0; i < kept_[b]; ++i) {
        const int at = first_[b] + row_order_[static_cast<std::size_t>(orders_[b] + i)];
        places_of_rows_[static_cast<std::size_t>(at)] = {static_cast<int>(f), row++};
      }
    }
  }
  remaining_.reserve(fronts_.size());
  arrange(true);
  most_numbers_ = numbers_;
  most_stairs_ = stairs_;
  arrange();
}

void FrontLayout::setPresent(const std::vector<bool>& present) {
  if (present_ == present) return;
  present_ = present;
  arrange();
}

std::size_t FrontLayout::deal(std::size_t count) {
  const std::size_t first = numbers_;
  constexpr std::size_t kChunk = kRowChunk;
  numbers_ += (count + kChunk - 1) / kChunk * kChunk;
  return first;
}

// Adds the columns of a block that are present, in a front whose columns local_ holds.
void FrontLayout::addBlock(std::size_t block, const std::vector<int>& columns) {
  const int begin = count(block_columns_);
  for (int j = 0; j < count(columns); ++j) {
    const int column = columns[static_cast<std::size_t>(j)];
    if (!present_[static_cast<std::size_t>(column)]) continue;
    block_columns_.push_back({j, local_[static_cast<std::size_t>(column)], column});
  }
  block_rows_.push_back({static_cast<int>(block), kept_[block],
                         static_cast<int>(blocks_[block].rows), orders_[block], first_[block],
                         begin, count(block_columns_)});
}

// A front hands on the rows that it has not made those of pivots, as far as they have entries.
// Where pivots are absent it hands on more: with `whatever`, as many as whatever columns are.
void FrontLayout::arrange(bool whatever) {
  remaining_.clear();
  shapes_.clear();
  block_rows_.clear();
  block_columns_.clear();
  children_.clear();
  places_.clear();
  columns_.clear();
  numbers_ = stairs_ = 0;
  present_columns_ = static_cast<int>(std::count(present_.begin(), present_.end(), true));
  for (const Front& front : fronts_) {
    FrontShape shape{};
    shape.parent = count(shapes_);
    shape.columns = count(columns_);
    for (const std::vector<int>* part : {&front.pivots, &front.rest}) {
      for (const int column : *part) {
        if (!present_[static_cast<std::size_t>(column)]) continue;
        local_[static_cast<std::size_t>(column)] = count(columns_) - shape.columns;
        columns_.push_back(column);
      }
      if (part == &front.pivots) shape.pivots = count(columns_) - shape.columns;
    }
    shape.width = count(columns_) - shape.columns;
    int rows = 0;
    shape.blocks_begin = count(block_rows_);
    for (const std::size_t b : front.blocks) {
      addBlock(b, blocks_[b].columns);
      rows += kept_[b];
    }
    shape.blocks_end = count(block_rows_);
    shape.children_begin = count(children_);
    for (const std::size_t child : front.children) {
      FrontShape& below = shapes_[child];
      below.parent = count(shapes_);
      children_.push_back({static_cast<int>(child), count(places_)});
      for (int j = below.pivots; j < below.width; ++j) {
        const int column = columns_[static_cast<std::size_t>(below.columns + j)];
        places_.push_back(local_[static_cast<std::size_t>(column)]);
      }
      rows += remaining_[child];
    }
    shape.children_end = count(children_);
    shape.depth = std::min(rows, shape.width);
    remaining_.push_back(whatever ? std::min(rows, shape.width - shape.pivots)
                                  : std::max(0, shape.depth - shape.pivots));
    shape.most_rows = (rows + kRowChunk - 1) / kRowChunk * kRowChunk;
    shape.stairs = static_cast<int>(stairs_);
    const auto most_rows = static_cast<std::size_t>(shape.most_rows);
    const auto depth = static_cast<std::size_t>(shape.depth);
    stairs_ += depth;
    shape.entries = deal(most_rows * static_cast<std::size_t>(shape.width));
    shape.reflections = deal(most_rows * depth);
    shape.factors = deal(depth);
    shape.reciprocals = deal(static_cast<std::size_t>(shape.pivots));
    shape.z = deal(most_rows);
    shapes_.push_back(shape);
  }
  view_ = {shapes_.data(),
           block_rows_.data(),
           block_columns_.data(),
           row_order_.data(),
           children_.data(),
           places_.data(),
           columns_.data(),
           count(shapes_),
           count(present_),
           0,
           0,
           0};
  view_.lengths = deal(present_.size());
  view_.sums = deal(present_.size());
  view_.solution = deal(present_.size());
}

std::size_t FrontLayout::filledRows() const {
  std::size_t filled = 0;
  for (std::size_t row = 0; row < rows(); ++row) filled += placeOf(row).front >= 0 ? 1 : 0;
  return filled;
}

}  // namespace virtual_work_dynamics
