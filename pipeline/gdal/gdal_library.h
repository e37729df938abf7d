// GDAL itself, loaded when its first function is called. It brings ninety libraries, which cost more time than a small build: a
// run that reads no raster and writes no GeoPackage does without.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

/// Every function of GDAL that this program calls, by its name in the C interface.
#define BLOCKRAND_GDAL_FUNCTIONS(F)   \
  F(CPLDefaultErrorHandler)           \
  F(CPLErrorReset)                    \
  F(CPLGetErrorHandlerUserData)       \
  F(CPLGetLastErrorMsg)               \
  F(CPLGetThreadLocalConfigOption)    \
  F(CPLPopErrorHandler)               \
  F(CPLPushErrorHandlerEx)            \
  F(CPLSetThreadLocalConfigOption)    \
  F(CSLDestroy)                       \
  F(CSLLoad)                          \
  F(GDALAllRegister)                  \
  F(GDALClose)                        \
  F(GDALCreate)                       \
  F(GDALDataTypeIsComplex)            \
  F(GDALDatasetCommitTransaction)     \
  F(GDALDatasetCreateLayer)           \
  F(GDALDatasetExecuteSQL)            \
  F(GDALDatasetGetLayer)              \
  F(GDALDatasetGetLayerByName)        \
  F(GDALDatasetGetLayerCount)         \
  F(GDALDatasetReleaseResultSet)      \
  F(GDALDatasetRollbackTransaction)   \
  F(GDALDatasetStartTransaction)      \
  F(GDALFlushCache)                   \
  F(GDALGetCacheMax64)                \
  F(GDALGetColorEntryAsRGB)           \
  F(GDALGetColorEntryCount)           \
  F(GDALGetDataTypeSizeBits)          \
  F(GDALGetDriverByName)              \
  F(GDALGetFileList)                  \
  F(GDALGetGeoTransform)              \
  F(GDALGetMaskBand)                  \
  F(GDALGetMaskFlags)                 \
  F(GDALGetMetadataItem)              \
  F(GDALGetRasterBand)                \
  F(GDALGetRasterColorInterpretation) \
  F(GDALGetRasterColorTable)          \
  F(GDALGetRasterCount)               \
  F(GDALGetRasterDataType)            \
  F(GDALGetRasterNoDataValue)         \
  F(GDALGetRasterOffset)              \
  F(GDALGetRasterScale)               \
  F(GDALGetRasterUnitType)            \
  F(GDALGetRasterXSize)               \
  F(GDALGetRasterYSize)               \
  F(GDALGetSpatialRef)                \
  F(GDALInvGeoTransform)              \
  F(GDALOpenEx)                       \
  F(GDALRasterIO)                     \
  F(GDALRasterIOEx)                   \
  F(GDALSetCacheMax64)                \
  F(OGR_FD_GetFieldCount)             \
  F(OGR_FD_GetFieldDefn)              \
  F(OGR_FD_GetFieldIndex)             \
  F(OGR_F_Create)                     \
  F(OGR_F_Destroy)                    \
  F(OGR_F_GetFID)                     \
  F(OGR_F_GetFieldAsDouble)           \
  F(OGR_F_GetFieldAsInteger64)        \
  F(OGR_F_GetFieldAsString)           \
  F(OGR_F_GetGeometryRef)             \
  F(OGR_F_IsFieldSetAndNotNull)       \
  F(OGR_F_SetFID)                     \
  F(OGR_F_SetFieldDouble)             \
  F(OGR_F_SetFieldInteger)            \
  F(OGR_F_SetFieldInteger64)          \
  F(OGR_F_SetFieldNull)               \
  F(OGR_F_SetFieldString)             \
  F(OGR_F_SetGeometry)                \
  F(OGR_F_SetGeometryDirectly)        \
  F(OGR_Fld_Create)                   \
  F(OGR_Fld_Destroy)                  \
  F(OGR_Fld_GetNameRef)               \
  F(OGR_Fld_GetSubType)               \
  F(OGR_Fld_GetType)                  \
  F(OGR_Fld_SetSubType)               \
  F(OGR_Fld_SetWidth)                 \
  F(OGR_GT_Flatten)                   \
  F(OGR_G_CreateFromWkbEx)            \
  F(OGR_G_DestroyGeometry)            \
  F(OGR_G_ExportToIsoWkb)             \
  F(OGR_G_GetGeometryCount)           \
  F(OGR_G_GetGeometryRef)             \
  F(OGR_G_GetGeometryType)            \
  F(OGR_G_GetLinearGeometry)          \
  F(OGR_G_GetPointCount)              \
  F(OGR_G_GetX)                       \
  F(OGR_G_GetY)                       \
  F(OGR_G_WkbSize)                    \
  F(OGR_L_CreateFeature)              \
  F(OGR_L_CreateField)                \
  F(OGR_L_GetGeomType)                \
  F(OGR_L_GetLayerDefn)               \
  F(OGR_L_GetName)                    \
  F(OGR_L_GetNextFeature)             \
  F(OGR_L_GetSpatialRef)              \
  F(OGR_L_ResetReading)               \
  F(OGR_L_SyncToDisk)                 \
  F(OSRDestroySpatialReference)       \
  F(OSREPSGTreatsAsLatLong)           \
  F(OSRExportToWktEx)                 \
  F(OSRFindMatches)                   \
  F(OSRFreeSRSArray)                  \
  F(OSRGetDataAxisToSRSAxisMapping)   \
  F(OSRImportFromESRI)                \
  F(OSRIsGeographic)                  \
  F(OSRNewSpatialReference)           \
  F(OSRSetAxisMappingStrategy)        \
  F(OSRSetFromUserInput)              \
  F(VSIFCloseL)                       \
  F(VSIFOpenL)                        \
  F(VSIFReadL)                        \
  F(VSIFree)                          \
  F(VSIStatL)

namespace blockrand::gdal {

struct Functions {
#define BLOCKRAND_GDAL_MEMBER(name) decltype(&::name) name = nullptr;
  BLOCKRAND_GDAL_FUNCTIONS(BLOCKRAND_GDAL_MEMBER)
#undef BLOCKRAND_GDAL_MEMBER
};

/// Safe to call from any thread; stays loaded to the end of the program.
/// \throws base::UsageError  GDAL is not there, or is another one than this program was compiled with
const Functions& api();

}  // namespace blockrand::gdal
