// A tensor tree as Radiance evaluates it.
#pragma once

#include "lobefit/io/bsdf_xml/blocks.h"
#include "lobefit/io/bsdf_xml/tensor_tree.h"
#include "lobefit/measurement/brdf_function.h"

namespace lobefit {

// The tree of one block. Throws InputError with the place in the file.
TensorTree ReadTree(const XmlFile& xml, const XmlBlock& block, int rank);

// f_r of the front of a file of tensor trees: that of the cell that holds the directions, without interpolation, as
// Radiance takes it. Throws InputError, also for matrices.
struct TreeLookup {
  Channels channels;
  BrdfFunction brdf;
};
TreeLookup LookUpTensorTrees(const InputFile& file);

}  // namespace lobefit
