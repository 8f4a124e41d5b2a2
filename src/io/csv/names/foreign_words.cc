#include "lobefit/io/csv/names/foreign_words.h"

#include <algorithm>
#include <array>

#include "lobefit/base/text/same_word.h"

namespace lobefit {
namespace {

struct Translation {
  std::string_view foreign, english;
};

// Longer ones before those that they begin with.
constexpr std::array<Translation, 72> kScripts = {{
    {"双向反射分布函数", "brdf"},
    {"双方向反射率分布関数", "brdf"},
    {"反射率因子", "reflectance factor"},
    {"反射率係数", "reflectance factor"},
    {"反射率系数", "reflectance factor"},
    {"亮度系数", "luminance coefficient"},
    {"亮度因数", "luminance factor"},
    {"輝度率", "luminance factor"},
    {"反射率", "reflectance"},
    {"入射", "incident"},
    {"照明", "illumination"},
    {"光源", "source"},
    {"受光", "detector"},
    {"探测", "detector"},
    {"接收", "receiver"},
    {"観測", "viewing"},
    {"观测", "viewing"},
    {"觀測", "viewing"},
    {"观察", "viewing"},
    {"反射", "reflected"},
    {"出射", "exit"},
    {"散射", "scatter"},
    {"散乱", "scatter"},
    {"方位", "azimuth"},
    {"天頂", "zenith"},
    {"天顶", "zenith"},
    {"仰角", "elevation"},
    {"高度角", "elevation"},
    {"弧度", "rad"},
    {"ラジアン", "rad"},
    {"角度", "angle"},
    {"角", "angle"},
    {"度", "deg"},
    {"相对", "relative"},
    {"相対", "relative"},
    {"相對", "relative"},
    {"差", "difference"},
    {"波长", "wavelength"},
    {"波長", "wavelength"},
    {"纳米", "nm"},
    {"不确定", "uncertainty"},
    {"不確かさ", "uncertainty"},
    {"标准差", "std"},
    {"標準偏差", "std"},
    {"偏振", "polarisation"},
    {"偏光", "polarisation"},
    {"值", "value"},
    {"値", "value"},
    {"的", ""},
    {"の", ""},
    {"（", "("},
    {"）", ")"},
    {"［", "["},
    {"］", "]"},
    {"입사", "incident"},
    {"반사", "reflected"},
    {"산란", "scatter"},
    {"수광", "detector"},
    {"관측", "viewing"},
    {"방위", "azimuth"},
    {"천정", "zenith"},
    {"각도", "angle"},
    {"각", "angle"},
    {"상대", "relative"},
    {"차이", "difference"},
    {"차", "difference"},
    {"파장", "wavelength"},
    {"도", "deg"},
    {"불확도", "uncertainty"},
    {"±", "uncertainty"},
    {"+/-", "uncertainty"},
    {"+-", "uncertainty"},
}};

// Beginnings of Russian words, in small letters; the ending of the word does not matter.
constexpr std::array<Translation, 27> kRussian = {{
    {"угол", "angle"},
    {"угл", "angle"},
    {"паден", "incident"},
    {"освещ", "illumination"},
    {"источник", "source"},
    {"наблюд", "viewing"},
    {"визир", "viewing"},
    {"отраж", "reflected"},
    {"рассея", "scatter"},
    {"детектор", "detector"},
    {"приемн", "receiver"},
    {"приёмн", "receiver"},
    {"азимут", "azimuth"},
    {"зенит", "zenith"},
    {"относит", "relative"},
    {"разност", "difference"},
    {"длин", ""},
    {"волн", "wavelength"},
    {"град", "deg"},
    {"рад", "rad"},
    {"стер", "sr"},
    {"ср", "sr"},
    {"нм", "nm"},
    {"мкм", "um"},
    {"неопред", "uncertainty"},
    {"погрешн", "uncertainty"},
    {"дфос", "brdf"},
}};

// Parts of Dutch, German and Scandinavian compounds, which are whole words too.
constexpr std::array<Translation, 58> kParts = {{
    {"einfalls", "incident"},
    {"einfall", "incident"},
    {"beleuchtungs", "illumination"},
    {"lichtquellen", "source"},
    {"quellen", "source"},
    {"ausfalls", "exit"},
    {"ausfall", "exit"},
    {"beobachtungs", "viewing"},
    {"betrachtungs", "viewing"},
    {"beobachter", "viewing"},
    {"detektor", "detector"},
    {"empfaenger", "receiver"},
    {"streu", "scatter"},
    {"reflexions", "reflected"},
    {"mess", ""},
    {"azimutal", "azimuth"},
    {"azimut", "azimuth"},
    {"azimuth", "azimuth"},
    {"zenit", "zenith"},
    {"zenith", "zenith"},
    {"polar", "polar"},
    {"elevations", "elevation"},
    {"hoehen", "elevation"},
    {"differenz", "difference"},
    {"winkel", "angle"},
    {"wellenlaenge", "wavelength"},
    {"wert", "value"},
    {"relativer", "relative"},
    {"unsicherheit", "uncertainty"},
    {"standardabweichung", "std"},
    {"invals", "incident"},
    {"kijk", "viewing"},
    {"waarnemings", "viewing"},
    {"uitvals", "exit"},
    {"hoek", "angle"},
    {"verschil", "difference"},
    {"golflengte", "wavelength"},
    {"onzekerheid", "uncertainty"},
    {"infalls", "incident"},
    {"utfalls", "exit"},
    {"observations", "viewing"},
    {"betraktnings", "viewing"},
    {"vinkel", "angle"},
    {"skillnad", "difference"},
    {"vaglangd", "wavelength"},
    {"bolgelaengde", "wavelength"},
    {"indfalds", "incident"},
    {"innfalls", "incident"},
    {"licht", ""},
    {"quelle", "source"},
    {"strahler", "source"},
    {"reflektions", "reflected"},
    {"inval", "incident"},
    {"uitval", "exit"},
    {"lichtbron", "source"},
    {"belysnings", "illumination"},
    {"mottagar", "receiver"},
    {"grader", "deg"},
}};

constexpr std::array<Translation, 87> kForeignWords = {{
    {"rot", "red"},
    {"gruen", "green"},
    {"blau", "blue"},
    {"rouge", "red"},
    {"vert", "green"},
    {"bleu", "blue"},
    {"rosso", "red"},
    {"verde", "green"},
    {"blu", "blue"},
    {"rojo", "red"},
    {"azul", "blue"},
    {"angulo", "angle"},
    {"angolo", "angle"},
    {"kat", "angle"},
    {"uhel", "angle"},
    {"incidencia", "incident"},
    {"incidenza", "incident"},
    {"padania", "incident"},
    {"dopadu", "incident"},
    {"iluminacion", "illumination"},
    {"illuminazione", "illumination"},
    {"eclairage", "illumination"},
    {"fuente", "source"},
    {"sorgente", "source"},
    {"observacion", "viewing"},
    {"observacao", "viewing"},
    {"osservazione", "viewing"},
    {"obserwacji", "viewing"},
    {"pozorovani", "viewing"},
    {"vision", "viewing"},
    {"visao", "viewing"},
    {"vue", "viewing"},
    {"visee", "viewing"},
    {"vista", "viewing"},
    {"detecteur", "detector"},
    {"recepteur", "receiver"},
    {"rivelatore", "detector"},
    {"receptor", "receiver"},
    {"reflexao", "reflected"},
    {"riflessione", "reflected"},
    {"odbicia", "reflected"},
    {"odrazu", "reflected"},
    {"dispersion", "scatter"},
    {"espalhamento", "scatter"},
    {"diffusione", "scatter"},
    {"salida", "exit"},
    {"uscita", "exit"},
    {"cenital", "zenith"},
    {"cenit", "zenith"},
    {"zenithal", "zenith"},
    {"zenitale", "zenith"},
    {"zenital", "zenith"},
    {"zenitalny", "zenith"},
    {"azimute", "azimuth"},
    {"azimutale", "azimuth"},
    {"acimutal", "azimuth"},
    {"azymut", "azimuth"},
    {"azymutalny", "azimuth"},
    {"relativo", "relative"},
    {"relativa", "relative"},
    {"wzgledny", "relative"},
    {"relativni", "relative"},
    {"diferencia", "difference"},
    {"differenza", "difference"},
    {"diferenca", "difference"},
    {"ecart", "difference"},
    {"incerteza", "uncertainty"},
    {"niepewnosc", "uncertainty"},
    {"nejistota", "uncertainty"},
    {"valor", "value"},
    {"valore", "value"},
    {"valeur", "value"},
    {"eclairement", "illumination"},
    {"iluminacao", "illumination"},
    {"oswietlenia", "illumination"},
    {"osvetleni", "illumination"},
    {"incidente", "incident"},
    {"emetteur", "source"},
    {"reflechie", "reflected"},
    {"reflejado", "reflected"},
    {"reflejada", "reflected"},
    {"riflesso", "reflected"},
    {"riflessa", "reflected"},
    {"dispersado", "scatter"},
    {"deteccion", "detector"},
    {"rivelazione", "detector"},
    {"detektora", "detector"},
}};

constexpr auto kForeignOf = [](const Translation& translation) { return translation.foreign; };
constexpr ByFirstByte<kScripts.size()> kScriptsByByte(kScripts, kForeignOf);
constexpr ByFirstByte<kForeignWords.size()> kForeignWordsByByte(kForeignWords, kForeignOf);
constexpr ByFirstByte<kParts.size()> kPartsByByte(kParts, kForeignOf);

// Two bytes of UTF-8 as a small Cyrillic letter; empty where they are none.
std::string CyrillicLetter(std::string_view text) {
  if (text.size() < 2) return "";
  const auto lead = static_cast<unsigned char>(text[0]), last = static_cast<unsigned char>(text[1]);
  if ((lead != 0xd0 && lead != 0xd1) || (last & 0xc0U) != 0x80U) return "";
  unsigned code = ((lead & 0x1fU) << 6U) | (last & 0x3fU);
  if (code == 0x401) code = 0x451;
  if (code >= 0x410 && code < 0x430) code += 0x20;
  return {static_cast<char>(0xc0U | (code >> 6U)), static_cast<char>(0x80U | (code & 0x3fU))};
}

// Parts that make up the whole of the word.
bool Decompose(std::string_view word, std::vector<std::string_view>* english) {
  if (word.empty()) return true;
  const std::size_t found = kPartsByByte.Find(word, [&](std::size_t i) {
    const Translation& part = kParts[i];
    if (!word.starts_with(part.foreign)) return false;
    english->push_back(part.english);
    if (Decompose(word.substr(part.foreign.size()), english)) return true;
    english->pop_back();
    return false;
  });
  return found < kParts.size();
}

}  // namespace

std::string TranslateScripts(std::string_view name) {
  std::string text;
  while (!name.empty()) {
    const std::size_t found =
        kScriptsByByte.Find(name, [&](std::size_t i) { return name.starts_with(kScripts[i].foreign); });
    if (found < kScripts.size()) {
      const std::string english(kScripts[found].english);
      const bool bracket = english.size() == 1;
      text += bracket ? english : " " + english + " ";
      name.remove_prefix(kScripts[found].foreign.size());
      continue;
    }
    std::string letter = CyrillicLetter(name);
    if (letter.empty()) {
      text += name.front();
      name.remove_prefix(1);
      continue;
    }
    std::string word;
    for (; !letter.empty(); letter = CyrillicLetter(name)) {
      word += letter;
      name.remove_prefix(2);
    }
    const auto* known = std::find_if(kRussian.begin(), kRussian.end(),
                                     [&](const Translation& t) { return word.starts_with(t.foreign); });
    text += known != kRussian.end() ? " " + std::string(known->english) + " " : word;
  }
  return text;
}

std::vector<std::string_view> TranslateWord(std::string_view word) {
  const std::size_t known =
      kForeignWordsByByte.Find(word, [&](std::size_t i) { return SameWord(kForeignWords[i].foreign, word); });
  if (known < kForeignWords.size()) return {kForeignWords[known].english};
  constexpr std::size_t kLongest = 60;
  std::vector<std::string_view> english;
  if (word.size() > kLongest || !Decompose(word, &english)) return {};
  return english;
}

}  // namespace lobefit
