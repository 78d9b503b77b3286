#include <array>

#include "harness/line/frame_check.hpp"

// Source: the public CRC catalogues. The values were compared between two independent catalogues (the RevEng
// catalogue of parametrised CRC algorithms and the crc-catalog package); a row marked kOnlyOne is listed by
// the latter alone. Every check value and residue here is recomputed by the test beside this file.

namespace fieldproof::line {
namespace {

constexpr bool kBoth = true;
constexpr bool kOnlyOne = false;

constexpr FrameCheckValue wide(std::uint64_t high, std::uint64_t low) {
  return (FrameCheckValue{high} << 64) | low;
}

// clang-format off
constexpr std::array kCatalogue = std::to_array<FrameCheckParameters>({
    {"CRC-3/GSM", 3, 0x3, 0x0, false, false, 0x7, 0x4, 0x2, kBoth, ""},
    {"CRC-3/ROHC", 3, 0x3, 0x7, true, true, 0x0, 0x6, 0x0, kBoth, ""},
    {"CRC-4/G-704", 4, 0x3, 0x0, true, true, 0x0, 0x7, 0x0, kBoth, "CRC-4/ITU"},
    {"CRC-4/INTERLAKEN", 4, 0x3, 0xF, false, false, 0xF, 0xB, 0x2, kBoth, ""},
    {"CRC-5/EPC-C1G2", 5, 0x09, 0x09, false, false, 0x00, 0x00, 0x00, kBoth, "CRC-5/EPC"},
    {"CRC-5/G-704", 5, 0x15, 0x00, true, true, 0x00, 0x07, 0x00, kBoth, "CRC-5/ITU"},
    {"CRC-5/USB", 5, 0x05, 0x1F, true, true, 0x1F, 0x19, 0x06, kBoth, ""},
    {"CRC-6/CDMA2000-A", 6, 0x27, 0x3F, false, false, 0x00, 0x0D, 0x00, kBoth, ""},
    {"CRC-6/CDMA2000-B", 6, 0x07, 0x3F, false, false, 0x00, 0x3B, 0x00, kBoth, ""},
    {"CRC-6/DARC", 6, 0x19, 0x00, true, true, 0x00, 0x26, 0x00, kBoth, ""},
    {"CRC-6/G-704", 6, 0x03, 0x00, true, true, 0x00, 0x06, 0x00, kBoth, "CRC-6/ITU"},
    {"CRC-6/GSM", 6, 0x2F, 0x00, false, false, 0x3F, 0x13, 0x3A, kBoth, ""},
    {"CRC-7/MMC", 7, 0x09, 0x00, false, false, 0x00, 0x75, 0x00, kBoth, "CRC-7"},
    {"CRC-7/ROHC", 7, 0x4F, 0x7F, true, true, 0x00, 0x53, 0x00, kBoth, ""},
    {"CRC-7/UMTS", 7, 0x45, 0x00, false, false, 0x00, 0x61, 0x00, kBoth, ""},
    {"CRC-8/AUTOSAR", 8, 0x2F, 0xFF, false, false, 0xFF, 0xDF, 0x42, kBoth, ""},
    {"CRC-8/BLUETOOTH", 8, 0xA7, 0x00, true, true, 0x00, 0x26, 0x00, kBoth, ""},
    {"CRC-8/CDMA2000", 8, 0x9B, 0xFF, false, false, 0x00, 0xDA, 0x00, kBoth, ""},
    {"CRC-8/DARC", 8, 0x39, 0x00, true, true, 0x00, 0x15, 0x00, kBoth, ""},
    {"CRC-8/DVB-S2", 8, 0xD5, 0x00, false, false, 0x00, 0xBC, 0x00, kBoth, ""},
    {"CRC-8/GSM-A", 8, 0x1D, 0x00, false, false, 0x00, 0x37, 0x00, kBoth, ""},
    {"CRC-8/GSM-B", 8, 0x49, 0x00, false, false, 0xFF, 0x94, 0x53, kBoth, ""},
    {"CRC-8/I-432-1", 8, 0x07, 0x00, false, false, 0x55, 0xA1, 0xAC, kBoth, "CRC-8/ITU"},
    {"CRC-8/I-CODE", 8, 0x1D, 0xFD, false, false, 0x00, 0x7E, 0x00, kBoth, ""},
    {"CRC-8/LTE", 8, 0x9B, 0x00, false, false, 0x00, 0xEA, 0x00, kBoth, ""},
    {"CRC-8/MAXIM-DOW", 8, 0x31, 0x00, true, true, 0x00, 0xA1, 0x00, kBoth, "CRC-8/MAXIM, DOW-CRC"},
    {"CRC-8/MIFARE-MAD", 8, 0x1D, 0xC7, false, false, 0x00, 0x99, 0x00, kBoth, ""},
    {"CRC-8/NRSC-5", 8, 0x31, 0xFF, false, false, 0x00, 0xF7, 0x00, kBoth, ""},
    {"CRC-8/OPENSAFETY", 8, 0x2F, 0x00, false, false, 0x00, 0x3E, 0x00, kBoth, ""},
    {"CRC-8/ROHC", 8, 0x07, 0xFF, true, true, 0x00, 0xD0, 0x00, kBoth, ""},
    {"CRC-8/SAE-J1850", 8, 0x1D, 0xFF, false, false, 0xFF, 0x4B, 0xC4, kBoth, ""},
    {"CRC-8/SMBUS", 8, 0x07, 0x00, false, false, 0x00, 0xF4, 0x00, kBoth, "CRC-8"},
    {"CRC-8/TECH-3250", 8, 0x1D, 0xFF, true, true, 0x00, 0x97, 0x00, kBoth, "CRC-8/AES, CRC-8/EBU"},
    {"CRC-8/WCDMA", 8, 0x9B, 0x00, true, true, 0x00, 0x25, 0x00, kBoth, ""},
    {"CRC-8/HITAG", 8, 0x1D, 0xFF, false, false, 0x00, 0xB4, 0x00, kOnlyOne, ""},
    {"CRC-10/ATM", 10, 0x233, 0x000, false, false, 0x000, 0x199, 0x000, kBoth, "CRC-10, CRC-10/I-610"},
    {"CRC-10/CDMA2000", 10, 0x3D9, 0x3FF, false, false, 0x000, 0x233, 0x000, kBoth, ""},
    {"CRC-10/GSM", 10, 0x175, 0x000, false, false, 0x3FF, 0x12A, 0x0C6, kBoth, ""},
    {"CRC-11/FLEXRAY", 11, 0x385, 0x01A, false, false, 0x000, 0x5A3, 0x000, kBoth, "CRC-11"},
    {"CRC-11/UMTS", 11, 0x307, 0x000, false, false, 0x000, 0x061, 0x000, kBoth, ""},
    {"CRC-12/CDMA2000", 12, 0xF13, 0xFFF, false, false, 0x000, 0xD4D, 0x000, kBoth, ""},
    {"CRC-12/DECT", 12, 0x80F, 0x000, false, false, 0x000, 0xF5B, 0x000, kBoth, "CRC-12-X"},
    {"CRC-12/GSM", 12, 0xD31, 0x000, false, false, 0xFFF, 0xB34, 0x178, kBoth, ""},
    {"CRC-12/UMTS", 12, 0x80F, 0x000, false, true, 0x000, 0xDAF, 0x000, kBoth, "CRC-12/3GPP"},
    {"CRC-13/BBC", 13, 0x1CF5, 0x0000, false, false, 0x0000, 0x04FA, 0x0000, kBoth, ""},
    {"CRC-14/DARC", 14, 0x0805, 0x0000, true, true, 0x0000, 0x082D, 0x0000, kBoth, ""},
    {"CRC-14/GSM", 14, 0x202D, 0x0000, false, false, 0x3FFF, 0x30AE, 0x031E, kBoth, ""},
    {"CRC-15/CAN", 15, 0x4599, 0x0000, false, false, 0x0000, 0x059E, 0x0000, kBoth, "CRC-15"},
    {"CRC-15/MPT1327", 15, 0x6815, 0x0000, false, false, 0x0001, 0x2566, 0x6815, kBoth, ""},
    {"CRC-16/ARC", 16, 0x8005, 0x0000, true, true, 0x0000, 0xBB3D, 0x0000, kBoth, "ARC, CRC-16/LHA, CRC-IBM"},
    {"CRC-16/CDMA2000", 16, 0xC867, 0xFFFF, false, false, 0x0000, 0x4C06, 0x0000, kBoth, ""},
    {"CRC-16/CMS", 16, 0x8005, 0xFFFF, false, false, 0x0000, 0xAEE7, 0x0000, kBoth, ""},
    {"CRC-16/DDS-110", 16, 0x8005, 0x800D, false, false, 0x0000, 0x9ECF, 0x0000, kBoth, ""},
    {"CRC-16/DECT-R", 16, 0x0589, 0x0000, false, false, 0x0001, 0x007E, 0x0589, kBoth, "R-CRC-16"},
    {"CRC-16/DECT-X", 16, 0x0589, 0x0000, false, false, 0x0000, 0x007F, 0x0000, kBoth, "X-CRC-16"},
    {"CRC-16/DNP", 16, 0x3D65, 0x0000, true, true, 0xFFFF, 0xEA82, 0x66C5, kBoth, ""},
    {"CRC-16/EN-13757", 16, 0x3D65, 0x0000, false, false, 0xFFFF, 0xC2B7, 0xA366, kBoth, ""},
    {"CRC-16/GENIBUS", 16, 0x1021, 0xFFFF, false, false, 0xFFFF, 0xD64E, 0x1D0F, kBoth, "CRC-16/DARC, CRC-16/EPC, CRC-16/EPC-C1G2, CRC-16/I-CODE"},
    {"CRC-16/GSM", 16, 0x1021, 0x0000, false, false, 0xFFFF, 0xCE3C, 0x1D0F, kBoth, ""},
    {"CRC-16/IBM-3740", 16, 0x1021, 0xFFFF, false, false, 0x0000, 0x29B1, 0x0000, kBoth, "CRC-16/AUTOSAR, CRC-16/CCITT-FALSE"},
    {"CRC-16/IBM-SDLC", 16, 0x1021, 0xFFFF, true, true, 0xFFFF, 0x906E, 0xF0B8, kBoth, "CRC-16/ISO-HDLC, CRC-16/ISO-IEC-14443-3-B, CRC-16/X-25, CRC-B, X-25"},
    {"CRC-16/ISO-IEC-14443-3-A", 16, 0x1021, 0xC6C6, true, true, 0x0000, 0xBF05, 0x0000, kBoth, "CRC-A"},
    {"CRC-16/KERMIT", 16, 0x1021, 0x0000, true, true, 0x0000, 0x2189, 0x0000, kBoth, "CRC-16/CCITT, CRC-16/CCITT-TRUE, CRC-16/V-41-LSB, CRC-CCITT, KERMIT"},
    {"CRC-16/LJ1200", 16, 0x6F63, 0x0000, false, false, 0x0000, 0xBDF4, 0x0000, kBoth, ""},
    {"CRC-16/MAXIM-DOW", 16, 0x8005, 0x0000, true, true, 0xFFFF, 0x44C2, 0xB001, kBoth, "CRC-16/MAXIM"},
    {"CRC-16/MCRF4XX", 16, 0x1021, 0xFFFF, true, true, 0x0000, 0x6F91, 0x0000, kBoth, ""},
    {"CRC-16/MODBUS", 16, 0x8005, 0xFFFF, true, true, 0x0000, 0x4B37, 0x0000, kBoth, "MODBUS"},
    {"CRC-16/NRSC-5", 16, 0x080B, 0xFFFF, true, true, 0x0000, 0xA066, 0x0000, kBoth, ""},
    {"CRC-16/OPENSAFETY-A", 16, 0x5935, 0x0000, false, false, 0x0000, 0x5D38, 0x0000, kBoth, ""},
    {"CRC-16/OPENSAFETY-B", 16, 0x755B, 0x0000, false, false, 0x0000, 0x20FE, 0x0000, kBoth, ""},
    {"CRC-16/PROFIBUS", 16, 0x1DCF, 0xFFFF, false, false, 0xFFFF, 0xA819, 0xE394, kBoth, "CRC-16/IEC-61158-2"},
    {"CRC-16/RIELLO", 16, 0x1021, 0xB2AA, true, true, 0x0000, 0x63D0, 0x0000, kBoth, ""},
    {"CRC-16/SPI-FUJITSU", 16, 0x1021, 0x1D0F, false, false, 0x0000, 0xE5CC, 0x0000, kBoth, "CRC-16/AUG-CCITT"},
    {"CRC-16/T10-DIF", 16, 0x8BB7, 0x0000, false, false, 0x0000, 0xD0DB, 0x0000, kBoth, ""},
    {"CRC-16/TELEDISK", 16, 0xA097, 0x0000, false, false, 0x0000, 0x0FB3, 0x0000, kBoth, ""},
    {"CRC-16/TMS37157", 16, 0x1021, 0x89EC, true, true, 0x0000, 0x26B1, 0x0000, kBoth, ""},
    {"CRC-16/UMTS", 16, 0x8005, 0x0000, false, false, 0x0000, 0xFEE8, 0x0000, kBoth, "CRC-16/BUYPASS, CRC-16/VERIFONE"},
    {"CRC-16/USB", 16, 0x8005, 0xFFFF, true, true, 0xFFFF, 0xB4C8, 0xB001, kBoth, ""},
    {"CRC-16/XMODEM", 16, 0x1021, 0x0000, false, false, 0x0000, 0x31C3, 0x0000, kBoth, "CRC-16/ACORN, CRC-16/LTE, CRC-16/V-41-MSB, XMODEM, ZMODEM"},
    {"CRC-16/M17", 16, 0x5935, 0xFFFF, false, false, 0x0000, 0x772B, 0x0000, kOnlyOne, ""},
    {"CRC-17/CAN-FD", 17, 0x1685B, 0x00000, false, false, 0x00000, 0x04F03, 0x00000, kBoth, ""},
    {"CRC-21/CAN-FD", 21, 0x102899, 0x000000, false, false, 0x000000, 0x0ED841, 0x000000, kBoth, ""},
    {"CRC-24/BLE", 24, 0x00065B, 0x555555, true, true, 0x000000, 0xC25A56, 0x000000, kBoth, ""},
    {"CRC-24/FLEXRAY-A", 24, 0x5D6DCB, 0xFEDCBA, false, false, 0x000000, 0x7979BD, 0x000000, kBoth, ""},
    {"CRC-24/FLEXRAY-B", 24, 0x5D6DCB, 0xABCDEF, false, false, 0x000000, 0x1F23B8, 0x000000, kBoth, ""},
    {"CRC-24/INTERLAKEN", 24, 0x328B63, 0xFFFFFF, false, false, 0xFFFFFF, 0xB4F3E6, 0x144E63, kBoth, ""},
    {"CRC-24/LTE-A", 24, 0x864CFB, 0x000000, false, false, 0x000000, 0xCDE703, 0x000000, kBoth, ""},
    {"CRC-24/LTE-B", 24, 0x800063, 0x000000, false, false, 0x000000, 0x23EF52, 0x000000, kBoth, ""},
    {"CRC-24/OPENPGP", 24, 0x864CFB, 0xB704CE, false, false, 0x000000, 0x21CF02, 0x000000, kBoth, "CRC-24"},
    {"CRC-24/OS-9", 24, 0x800063, 0xFFFFFF, false, false, 0xFFFFFF, 0x200FA5, 0x800FE3, kBoth, ""},
    {"CRC-30/CDMA", 30, 0x2030B9C7, 0x3FFFFFFF, false, false, 0x3FFFFFFF, 0x04C34ABF, 0x34EFA55A, kBoth, ""},
    {"CRC-31/PHILIPS", 31, 0x04C11DB7, 0x7FFFFFFF, false, false, 0x7FFFFFFF, 0x0CE9E46C, 0x4EAF26F1, kBoth, ""},
    {"CRC-32/AIXM", 32, 0x814141AB, 0x00000000, false, false, 0x00000000, 0x3010BF7F, 0x00000000, kBoth, "CRC-32Q"},
    {"CRC-32/AUTOSAR", 32, 0xF4ACFB13, 0xFFFFFFFF, true, true, 0xFFFFFFFF, 0x1697D06A, 0x904CDDBF, kBoth, ""},
    {"CRC-32/BASE91-D", 32, 0xA833982B, 0xFFFFFFFF, true, true, 0xFFFFFFFF, 0x87315576, 0x45270551, kBoth, "CRC-32D"},
    {"CRC-32/BZIP2", 32, 0x04C11DB7, 0xFFFFFFFF, false, false, 0xFFFFFFFF, 0xFC891918, 0xC704DD7B, kBoth, "CRC-32/AAL5, CRC-32/DECT-B, B-CRC-32"},
    {"CRC-32/CD-ROM-EDC", 32, 0x8001801B, 0x00000000, true, true, 0x00000000, 0x6EC2EDC4, 0x00000000, kBoth, ""},
    {"CRC-32/CKSUM", 32, 0x04C11DB7, 0x00000000, false, false, 0xFFFFFFFF, 0x765E7680, 0xC704DD7B, kBoth, "CKSUM, CRC-32/POSIX"},
    {"CRC-32/ISCSI", 32, 0x1EDC6F41, 0xFFFFFFFF, true, true, 0xFFFFFFFF, 0xE3069283, 0xB798B438, kBoth, "CRC-32/BASE91-C, CRC-32/CASTAGNOLI, CRC-32/INTERLAKEN, CRC-32C"},
    {"CRC-32/ISO-HDLC", 32, 0x04C11DB7, 0xFFFFFFFF, true, true, 0xFFFFFFFF, 0xCBF43926, 0xDEBB20E3, kBoth, "CRC-32, CRC-32/ADCCP, CRC-32/V-42, CRC-32/XZ, PKZIP"},
    {"CRC-32/JAMCRC", 32, 0x04C11DB7, 0xFFFFFFFF, true, true, 0x00000000, 0x340BC6D9, 0x00000000, kBoth, "JAMCRC"},
    {"CRC-32/MPEG-2", 32, 0x04C11DB7, 0xFFFFFFFF, false, false, 0x00000000, 0x0376E6E7, 0x00000000, kBoth, ""},
    {"CRC-32/XFER", 32, 0x000000AF, 0x00000000, false, false, 0x00000000, 0xBD0BE338, 0x00000000, kBoth, "XFER"},
    {"CRC-32/MEF", 32, 0x741B8CD7, 0xFFFFFFFF, true, true, 0x00000000, 0xD2C22F51, 0x00000000, kOnlyOne, ""},
    {"CRC-40/GSM", 40, 0x0004820009, 0x0000000000, false, false, 0xFFFFFFFFFF, 0xD4164FC646, 0xC4FF8071FF, kBoth, ""},
    {"CRC-64/ECMA-182", 64, 0x42F0E1EBA9EA3693, 0x0000000000000000, false, false, 0x0000000000000000, 0x6C40DF5F0B497347, 0x0000000000000000, kBoth, "CRC-64"},
    {"CRC-64/GO-ISO", 64, 0x000000000000001B, 0xFFFFFFFFFFFFFFFF, true, true, 0xFFFFFFFFFFFFFFFF, 0xB90956C775A41001, 0x5300000000000000, kBoth, ""},
    {"CRC-64/WE", 64, 0x42F0E1EBA9EA3693, 0xFFFFFFFFFFFFFFFF, false, false, 0xFFFFFFFFFFFFFFFF, 0x62EC59E3F1A4F00A, 0xFCACBEBD5931A992, kBoth, ""},
    {"CRC-64/XZ", 64, 0x42F0E1EBA9EA3693, 0xFFFFFFFFFFFFFFFF, true, true, 0xFFFFFFFFFFFFFFFF, 0x995DC9BBDF1939FA, 0x49958C9ABD7D353F, kBoth, "CRC-64/GO-ECMA"},
    {"CRC-64/MS", 64, 0x259C84CBA6426349, 0xFFFFFFFFFFFFFFFF, true, true, 0x0000000000000000, 0x75D4B74F024ECEEA, 0x0000000000000000, kOnlyOne, ""},
    {"CRC-64/NVME", 64, 0xAD93D23594C93659, 0xFFFFFFFFFFFFFFFF, true, true, 0xFFFFFFFFFFFFFFFF, 0xAE8B14860A799888, 0xF310303B2B6F6E42, kOnlyOne, ""},
    {"CRC-64/REDIS", 64, 0xAD93D23594C935A9, 0x0000000000000000, true, true, 0x0000000000000000, 0xE9C6D914C4B8D9CA, 0x0000000000000000, kOnlyOne, ""},
    {"CRC-82/DARC", 82, wide(0x0308C, 0x0111011401440411), wide(0x00000, 0x0000000000000000), true, true, wide(0x00000, 0x0000000000000000), wide(0x09EA8, 0x3F625023801FD612), wide(0x00000, 0x0000000000000000), kBoth, ""},
});
// clang-format on

}  // namespace

std::span<const FrameCheckParameters> frame_check_catalogue() {
  return kCatalogue;
}

}  // namespace fieldproof::line
