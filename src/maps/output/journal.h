// The journal of a run over a stack: one file a band of rows that is done, so that what was killed goes on, and so that
// several machines can share one picture.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "lobefit/maps/output/planes.h"

namespace lobefit {

class MapJournal {
 public:
  // `folder` is made. `key`: hexadecimal digest of everything that the maps depend on; bands of another key are as if
  // they were not there. Throws OutputError.
  MapJournal(std::filesystem::path folder, std::string key, std::size_t width, std::size_t height, std::size_t planes);

  // Writes a band by way of a temporary name. Callable from any thread. Throws OutputError.
  void Write(const MapRows& band) const;
  // Rows that no whole band of this key covers, as [first, end).
  std::vector<std::pair<std::size_t, std::size_t>> Missing() const;
  // Rows [first, end), which must be there. Throws InputError.
  MapRows Read(std::size_t first, std::size_t end) const;
  // Looks again at what is there.
  void Refresh();
  // Removes this key's bands, and the folder where it is empty then.
  void Remove() const;

 private:
  struct Band {
    std::size_t first, end;
    std::filesystem::path path;
  };
  std::filesystem::path folder_;
  std::string key_;
  std::size_t width_, height_, planes_;
  std::vector<Band> bands_;  // by first row
};

}  // namespace lobefit
