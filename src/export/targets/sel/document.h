// Export of tables of squared ellipsoidal lobes, which are no model of the surface: as the document and as shader text.
#pragma once

#include <memory>
#include <vector>

#include "lobefit/core/sel/sel_table.h"
#include "lobefit/export/targets/error_meter.h"
#include "lobefit/export/targets/target.h"
#include "lobefit/material/material.h"

namespace lobefit {

// Domain of all: material.sel is set.

// f_r of the table; owns what it needs.
BrdfFunction SelBrdf(const SelTable& table);
// At directions that suit the widths of the table's lobes.
ErrorMeter SelErrorMeter(const Material& material);
// Rows: lobes, bound where the table is one, channels, all exact.
std::vector<Carried> CarriesSel(const Material& material);

WrittenFiles WriteSelJson(const Material& material, const WriteContext& context);
WrittenFiles WriteSelGlsl(const Material& material, const WriteContext& context);

}  // namespace lobefit
