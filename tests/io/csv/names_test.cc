// Column names as programs, fields and languages write them.
#include "tests/io/csv/read_csv.h"

#include "lobefit/io/csv/names/columns.h"

namespace lobefit {
namespace {

void ExpectCoordinate(const char* name, Coordinate coordinate) {
  const CsvColumn column = ClassifyColumn(name);
  EXPECT_EQ(column.role, ColumnRole::kCoordinate) << name;
  EXPECT_EQ(column.coordinate, coordinate) << name;
  EXPECT_EQ(column.problem, "") << name;
}

TEST(CsvNames, ThePolarAngleOfTheLight) {
  for (const char* name : {"theta_i",
                           "thetai",
                           "Theta_In (deg)",
                           "AOI",
                           "aoi [°]",
                           "INC",
                           "incidence_deg",
                           "theta_i[rad]",
                           "theta-in",
                           "theta.i",
                           "theta i",
                           "ThetaIn",
                           "θi",
                           "θ_i",
                           "θᵢ",
                           "θ_inc / °",
                           "\\theta_i",
                           "$\\theta_{i}$",
                           "SZA",
                           "solar zenith angle",
                           "Incident angle",
                           "Incident angle (deg)",
                           "Angle of incidence",
                           "incident polar angle",
                           "zenith_i",
                           "polar_i",
                           "theta_light",
                           "theta_0",
                           "thetaL",
                           "illumination zenith",
                           "Einfallswinkel (°)",
                           "angle d'incidence",
                           "ángulo de incidencia",
                           "angolo di incidenza",
                           "elevation_i",
                           "source zenith",
                           "inc. angle",
                           "th_i"}) {
    ExpectCoordinate(name, Coordinate::kThetaI);
  }
}

TEST(CsvNames, ThePolarAngleOfTheViewer) {
  for (const char* name : {"theta_o",
                           "theta_r",
                           "thetas",
                           "theta_v",
                           "theta_out",
                           "thetar",
                           "receive_deg",
                           "theta-out",
                           "theta r",
                           "ThetaOut",
                           "θr",
                           "θ_s [°]",
                           "VZA",
                           "view zenith",
                           "Scatter angle",
                           "detection angle (deg)",
                           "AOS",
                           "viewing angle",
                           "Angle of reflection",
                           "zenith_r",
                           "theta_det",
                           "emission",
                           "emission angle",
                           "exit angle",
                           "observation zenith angle",
                           "Streuwinkel",
                           "Beobachtungswinkel [°]",
                           "angle de diffusion",
                           "reflected polar angle",
                           "sensor zenith",
                           "theta_refl"}) {
    ExpectCoordinate(name, Coordinate::kThetaO);
  }
}

TEST(CsvNames, Azimuths) {
  for (const char* name : {"phi_i", "phi-in", "φi", "SAA", "Incident azimuth", "azimuth_i", "PhiIn",
                           "incident azimuthal angle", "solar azimuth", "azimut incident"}) {
    ExpectCoordinate(name, Coordinate::kPhiI);
  }
  for (const char* name : {"phi_o", "phi_r", "phi-out", "φr", "VAA", "Scatter azimuth", "azimuth_r", "viewing azimuth",
                           "phi_s (deg)", "detector azimuth"}) {
    ExpectCoordinate(name, Coordinate::kPhiO);
  }
  for (const char* name : {"dphi", "delta_phi", "Δφ", "delta phi", "RAA", "relative azimuth", "relative azimuth angle",
                           "phi_diff", "phi_r - phi_i", "azimuth difference"}) {
    ExpectCoordinate(name, Coordinate::kDeltaPhi);
  }
  for (const char* name : {"phi", "azimuth", "φ", "Azimuth (deg)"}) ExpectCoordinate(name, Coordinate::kPhi);
  for (const char* name : {"theta", "zenith angle", "angle", "Winkel"}) ExpectCoordinate(name, Coordinate::kTheta);
}

TEST(CsvNames, OffsetsSinesHalfAnglesAndVectors) {
  for (const char* name : {"delta_theta", "theta_o - theta_i", "theta_s-theta_i", "θs − θi", "angle from specular",
                           "degrees from specular", "specular offset"}) {
    ExpectCoordinate(name, Coordinate::kFromSpecular);
    EXPECT_FALSE(ClassifyColumn(name).reversed) << name;
  }
  EXPECT_TRUE(ClassifyColumn("theta_i - theta_s").reversed);
  for (const char* name :
       {"beta-beta0", "beta - beta0", "β-β0", "|beta-beta0|", "|B-B0|", "delta beta", "sin(theta_s)-sin(theta_i)"})
    ExpectCoordinate(name, Coordinate::kBetaOffset);
  EXPECT_TRUE(ClassifyColumn("|beta - beta0|").magnitude);
  ExpectCoordinate("theta_h", Coordinate::kThetaH);
  ExpectCoordinate("theta_half", Coordinate::kThetaH);
  ExpectCoordinate("phi_h", Coordinate::kPhiH);
  ExpectCoordinate("theta_d", Coordinate::kThetaD);
  ExpectCoordinate("phi_d", Coordinate::kPhiD);
  ExpectCoordinate("wi_x", Coordinate::kWiX);
  ExpectCoordinate("wo.z", Coordinate::kWoZ);
  ExpectCoordinate("ly", Coordinate::kWiY);
  ExpectCoordinate("out_x", Coordinate::kWoX);
}

TEST(CsvNames, ValuesTheirKindsAndScales) {
  const auto kind = [](const char* name) { return ClassifyColumn(name).value_kind; };
  for (const char* name : {"value", "BRDF", "bsdf", "f", "fr", "f_r11", "fr_L_over_E", "f(1/sr)", "BRDF(sr^-1)",
                           "BRDF [sr⁻¹]", "BSDF / sr^-1", "mean BRDF", "BRDF (1/sr)"}) {
    const CsvColumn column = ClassifyColumn(name);
    EXPECT_EQ(column.role, ColumnRole::kValue) << name;
    EXPECT_EQ(column.problem, "") << name;
    EXPECT_TRUE(column.value_scale.value_or(ValueScale{}).IsIdentity()) << name;
  }
  for (const char* name :
       {"cosine corrected BRDF", "CCBSDF", "BRDF cosine-corrected (1/sr)", "f_cos_o", "BRDF*cos(theta_s)"})
    EXPECT_EQ(kind(name), ValueKind::kBrdfCosO) << name;
  for (const char* name : {"BRF", "reflectance factor", "radiance factor (1)", "pi*BRDF", "π f_r"})
    EXPECT_EQ(kind(name), ValueKind::kReflectanceFactor) << name;
  EXPECT_EQ(kind("I/F"), ValueKind::kReflectanceCosI);
  const auto scaled = [](const char* name, double number) {
    return ClassifyColumn(name).value_scale.value_or(ValueScale{}).Apply(number);
  };
  EXPECT_DOUBLE_EQ(scaled("BRDF (%)", 50), 0.5);
  EXPECT_DOUBLE_EQ(scaled("reflectance factor [%]", 50), 0.5);
  EXPECT_DOUBLE_EQ(scaled("BRDF (dB)", -20), 0.01);
  EXPECT_DOUBLE_EQ(scaled("BRDF [dB sr^-1]", 10), 10);
  EXPECT_DOUBLE_EQ(scaled("log10(BRDF)", -2), 0.01);
  EXPECT_DOUBLE_EQ(scaled("log10_brdf", 2), 100);
  EXPECT_DOUBLE_EQ(scaled("ln(BRDF)", 0), 1);
  EXPECT_DOUBLE_EQ(scaled("BRDF (1e-3/sr)", 5), 0.005);
  EXPECT_DOUBLE_EQ(scaled("BRDF (10^-3 sr^-1)", 5), 0.005);
  for (const char* name : {"BRDF x 1000", "1000 * BRDF", "10^3*BRDF", "BRDF*1e3 (1/sr)", "f_r \u00d7 1000"}) {
    EXPECT_EQ(ClassifyColumn(name).role, ColumnRole::kValue) << name;
    EXPECT_DOUBLE_EQ(scaled(name, 500), 0.5) << name;
  }
  EXPECT_DOUBLE_EQ(scaled("q (mcd/m\u00b2/lx)", 70), 0.07);
  EXPECT_DOUBLE_EQ(scaled("Luminance coefficient q (cd/m2/lx)", 0.07), 0.07);
  EXPECT_EQ(kind("f_r*pi"), ValueKind::kReflectanceFactor);
  // Times or divided by? And twice.
  EXPECT_NE(ClassifyColumn("BRDF (x1000)").problem, "");
  EXPECT_NE(ClassifyColumn("BRDF (\u00d71000)").problem, "");
  EXPECT_NE(ClassifyColumn("100*BRDF (%)").problem, "");
  EXPECT_TRUE(ClassifyColumn("intensity (a.u.)").value_scale->arbitrary);
  EXPECT_NE(ClassifyColumn("BRDF (W/m2)").problem, "");
}

TEST(CsvNames, UncertaintiesAndWhatTheyAreRelativeTo) {
  for (const char* name : {"sigma", "std", "stdev", "uBRDF", "u(BRDF)", "BRDF uncertainty", "Unsicherheit",
                           "incertitude", "standard deviation", "sigma (1/sr)", "BRDF_std"}) {
    const CsvColumn column = ClassifyColumn(name);
    EXPECT_EQ(column.role, ColumnRole::kSigma) << name;
    EXPECT_FALSE(column.relative) << name;
    EXPECT_EQ(column.coverage_factor, 1) << name;
  }
  for (const char* name : {"relative uncertainty", "u_rel", "uncertainty (%)", "sigma [%]", "rel. std", "CV"}) {
    EXPECT_EQ(ClassifyColumn(name).role, ColumnRole::kSigma) << name;
    EXPECT_TRUE(ClassifyColumn(name).relative) << name;
  }
  EXPECT_EQ(ClassifyColumn("U (k=2)").coverage_factor, 2);
  EXPECT_EQ(ClassifyColumn("expanded uncertainty (k = 2)").coverage_factor, 2);
  EXPECT_NE(ClassifyColumn("expanded uncertainty").problem, "");
  EXPECT_TRUE(ClassifyColumn("variance").variance);
  EXPECT_EQ(ClassifyColumn("sigma_550nm").channel, "550nm");
}

TEST(CsvNames, ChannelsAndWavelengths) {
  for (const char* name : {"R", "red", "brdf_r", "Red BRDF"}) {
    if (std::string_view(name) == "brdf_r") continue;  // f_r of the BRDF unless siblings stand beside it
    EXPECT_EQ(ClassifyColumn(name).channel, "R") << name;
  }
  for (const char* name : {"550nm", "550 nm", "0.55um", "0.55 µm", "lambda=550", "λ=550 nm", "BRDF 550nm", "f_550nm",
                           "brdf_550", "550", "5500 Å"}) {
    EXPECT_EQ(ClassifyColumn(name).role, ColumnRole::kChannel) << name;
    EXPECT_EQ(ClassifyColumn(name).channel, "550nm") << name;
  }
  for (const char* name : {"wavelength", "Wavelength (nm)", "lambda", "λ [nm]", "WL (nm)", "wavelength_um",
                           "Wellenlänge", "longueur d'onde", "wavenumber (cm^-1)", "wl"}) {
    EXPECT_EQ(ClassifyColumn(name).role, ColumnRole::kWavelength) << name;
  }
  EXPECT_EQ(ClassifyColumn("foo").role, ColumnRole::kUnknown);
  EXPECT_EQ(ClassifyColumn("-3nm").role, ColumnRole::kUnknown);
  EXPECT_TRUE(LooksLikeAngle(ClassifyColumn("tilt")));
  EXPECT_TRUE(LooksLikeAngle(ClassifyColumn("gamma (deg)")));
  EXPECT_FALSE(LooksLikeAngle(ClassifyColumn("operator name")));
}

// The same four angles under ten namings give the same directions.
TEST(CsvNames, TenNamingsOfTheSameRows) {
  for (const char* names :
       {"theta-in,phi-in,theta-out,phi-out,BRDF", "SZA,SAA,VZA,VAA,BRDF", "ThetaIn,PhiIn,ThetaOut,PhiOut,BRDF",
        "theta i,phi i,theta s,phi s,BRDF", "Incident angle,Incident azimuth,Scatter angle,Scatter azimuth,BRDF",
        "θi,φi,θr,φr,BRDF", "theta.i,phi.i,theta.r,phi.r,BRDF", "zenith_i,azimuth_i,zenith_r,azimuth_r,BRDF",
        "incidence,azimuth,emission,phase,BRDF", "theta_s,phi_s,theta_v,phi_v,BRDF"}) {
    const Measurement m = ReadText(std::string(names) + "\n30,10,50,130,0.5\n30,10,20,200,0.25\n");
    ASSERT_EQ(m.samples.size(), 2U) << names;
    ExpectSample(m, 0, 30, 10, 50, 130, 0.5);
    ExpectSample(m, 1, 30, 10, 20, 200, 0.25);
  }
}

// A planetary file whose phase angle is the angle between the directions: azimuth is then relative.
TEST(CsvNames, APhaseAngleThatIsOne) {
  const Measurement m = ReadText("incidence,emission,azimuth,phase,BRDF\n30,30,180,60,0.5\n30,30,0,0,0.25\n");
  ExpectSample(m, 0, 30, 0, 30, 180, 0.5);
  ExpectSample(m, 1, 30, 0, 30, 0, 0.25);
  const Measurement only = ReadText("incidence,emission,phase,BRDF\n30,30,60,0.5\n");
  ExpectSample(only, 0, 30, 0, 30, 180, 0.5);
}

TEST(CsvNames, ElevationsCountFromTheSurface) {
  const Measurement m = ReadText("elevation_i,azimuth_i,elevation_r,azimuth_r,BRDF\n60,10,40,130,0.5\n");
  ExpectSample(m, 0, 30, 10, 50, 130, 0.5);
}

// Columns of the same four meanings in the languages of laboratories.
TEST(CsvNames, InOtherLanguages) {
  for (const char* name : {"Einfallswinkel [°]", "Einfallszenit [Grad]", "Beleuchtungswinkel", "invalshoek (°)",
                           "infallsvinkel", "kąt padania [°]", "ângulo de incidência (graus)", "úhel dopadu",
                           "угол падения (град)", "入射角(度)", "入射天顶角(°)", "입사각(도)"})
    ExpectCoordinate(name, Coordinate::kThetaI);
  for (const char* name : {"Beobachtungswinkel [°]", "Ausfallszenit [Grad]", "kijkhoek (°)",
                           "Ángulo de observación (°)", "Angolo di osservazione [°]", "kąt obserwacji [°]",
                           "угол наблюдения", "受光角(度)", "观测天顶角(°)", "反射角", "반사각(도)"})
    ExpectCoordinate(name, Coordinate::kThetaO);
  for (const char* name : {"Azimutdifferenz [°]", "azimutverschil", "Azimut relativo", "azymut względny [°]",
                           "относительный азимут (град)", "方位角差(度)", "相对方位角(°)"})
    ExpectCoordinate(name, Coordinate::kDeltaPhi);
  EXPECT_EQ(*ClassifyColumn("Einfallszenit [Grad]").angle_unit, AngleUnit::kDegrees);
  EXPECT_EQ(*ClassifyColumn("入射角（弧度）").angle_unit, AngleUnit::kRadians);
  EXPECT_NE(ClassifyColumn("theta_i [grad]").problem, "") << "the gon beside English words";
  EXPECT_EQ(ClassifyColumn("FDRB (sr-1)").role, ColumnRole::kValue);
  EXPECT_EQ(ClassifyColumn("ДФОС (1/ср)").role, ColumnRole::kValue);
  EXPECT_EQ(ClassifyColumn("波長(nm)").role, ColumnRole::kWavelength);
  EXPECT_EQ(ClassifyColumn("±").role, ColumnRole::kSigma);
  for (const char* names : {"Rot,Grün,Blau", "rouge,vert,bleu", "rojo,verde,azul"})
    EXPECT_EQ(ReadText("theta_i,theta_o," + std::string(names) + "\n10,20,1,2,3\n").channels.names,
              (std::vector<std::string>{"R", "G", "B"}));
}

TEST(CsvNames, UnitsThatHaveSignsOfTheirOwn) {
  ExpectCoordinate("source_el", Coordinate::kThetaI);
  ExpectCoordinate("thetaIRad", Coordinate::kThetaI);
  EXPECT_EQ(*ClassifyColumn("thetaIRad").angle_unit, AngleUnit::kRadians);
  for (const char* name : {"brdf_1/sr", "brdf_per_sr", "brdf_sr-1", "BRDF sr^-1", "BRDF (inverse steradian)"}) {
    const CsvColumn column = ClassifyColumn(name);
    EXPECT_EQ(column.role, ColumnRole::kValue) << name;
    EXPECT_EQ(column.problem, "") << name;
  }
  EXPECT_EQ(ClassifyColumn("1000 cm-1").wavelength_nm, 10000);
  EXPECT_EQ(ClassifyColumn("frequency (THz)").role, ColumnRole::kWavelength);
  EXPECT_EQ(ClassifyColumn("frequency (GHz)").wavelength_unit->ToNm(299792.458), 1000);
  EXPECT_EQ(ClassifyColumn("wavenumber (1/m)").wavelength_unit->ToNm(1e6), 1000);
  EXPECT_EQ(ClassifyColumn("frequency").role, ColumnRole::kUnknown) << "it may be that of a chopper";
}

TEST(CsvNames, AnUnknownUnitOfAnAngleIsNotPassedOver) {
  EXPECT_NE(
      MessageOf("theta_i,theta_o,dphi [turn],brdf\n10,20,0.5,1\n").find("'dphi [turn]', which speaks of an angle"),
      std::string::npos);
}

TEST(CsvNames, OfBothSides) {
  const auto coordinates = [](const std::vector<const char*>& names, Coordinate expected) {
    for (const char* name : names) {
      const CsvColumn column = ClassifyColumn(name);
      EXPECT_EQ(column.role, ColumnRole::kCoordinate) << name;
      EXPECT_EQ(column.coordinate, expected) << name;
      EXPECT_EQ(column.problem, "") << name;
    }
  };
  coordinates({"emitter_theta", "Tx_theta", "Lichteinfall Theta", "Quelle Theta", "Angle d'\u00e9clairement",
               "\u00e1ngulo incidente", "invalshoek", "theta_i (\u00c2\u00b0)", "theta_i (\ufffd)", "theta_i (deg.)"},
              Coordinate::kThetaI);
  coordinates({"Ref_Theta", "Theta Reflectance", "thetaRef (deg)", "Rx_theta", "Empf\u00e4nger Theta",
               "reflektionsvinkel", "\u200btheta_o", "EMI", "Scatter (deg)"},
              Coordinate::kThetaO);
  coordinates({"azimut inval"}, Coordinate::kPhiI);
  coordinates({"azimut uitval", "reflektionsazimut"}, Coordinate::kPhiO);
}

TEST(CsvNames, WavelengthsInBracketsBesideAUnit) {
  for (const char* name : {"BRDF (633 nm) [1/sr]", "f_r(633 nm)", "f_r 633"}) {
    const CsvColumn column = ClassifyColumn(name);
    EXPECT_EQ(column.role, ColumnRole::kChannel) << name;
    EXPECT_EQ(column.wavelength_nm, 633) << name;
    EXPECT_EQ(column.value_kind, ValueKind::kBrdf) << name;
    EXPECT_EQ(column.problem, "") << name;
  }
}

}  // namespace
}  // namespace lobefit
