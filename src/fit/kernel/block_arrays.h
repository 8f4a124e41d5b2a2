// The memory of a block's stages. Internal to the kernel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lobefit {

// 256 samples: the columns of one channel of a one-lobe model take 16 KB, half of a first-level cache.
inline constexpr std::size_t kBlock = 256;

// Arrays of kBlock in one piece: a fit of 200 samples is made of passes that take 5 us, and one allocation for each
// array would be a part of that. Stages name what they want as they are made and stay where they are; the block then
// allocates all at once.
class BlockArrays {
 public:
  // `blocks` arrays behind one another, each value `fill`, or undefined.
  void Want(std::span<double>* array, std::size_t blocks, std::optional<double> fill = std::nullopt) {
    wanted_.push_back({array, blocks * kBlock, fill});
  }

  void Allocate() {
    std::size_t size = 0;
    for (const Wanted& wanted : wanted_) size += wanted.size;
    memory_ = std::make_unique_for_overwrite<double[]>(size);
    double* next = memory_.get();
    for (const Wanted& wanted : wanted_) {
      *wanted.array = {next, wanted.size};
      if (wanted.fill) std::fill_n(next, wanted.size, *wanted.fill);
      next += wanted.size;
    }
    wanted_.clear();
  }

 private:
  struct Wanted {
    std::span<double>* array;
    std::size_t size;
    std::optional<double> fill;
  };
  std::vector<Wanted> wanted_;
  std::unique_ptr<double[]> memory_;
};

}  // namespace lobefit
