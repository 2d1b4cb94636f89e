; Installs NEP Studio for one person of a Windows computer: no administrator is asked.
; makensis -DVERSION=0.1.0 -DPROGRAM=dist\nep-studio -DICON=nep-studio.ico -DOUTPUT=NEP-Studio.exe nep-studio.nsi
; Paths are absolute. packaging/nsis.py calls it.

Unicode true
ManifestDPIAware true
RequestExecutionLevel user
SetCompressor /SOLID lzma
SetCompressorDictSize 64

!include "MUI2.nsh"
!include "FileFunc.nsh"
!include "LogicLib.nsh"
!include "x64.nsh"

!define TITLE "NEP Studio"
!define KEY "nep-studio"
!define KIND "NEPStudio.Project"
!define UNINSTALL "Software\Microsoft\Windows\CurrentVersion\Uninstall\${KEY}"

Name "${TITLE}"
OutFile "${OUTPUT}"
InstallDir "$LOCALAPPDATA\Programs\NEP Studio"
InstallDirRegKey HKCU "Software\${KEY}" "Folder"
BrandingText "${TITLE} ${VERSION}"
VIProductVersion "${VERSION}.0"
VIAddVersionKey "ProductName" "${TITLE}"
VIAddVersionKey "FileDescription" "${TITLE} installer"
VIAddVersionKey "FileVersion" "${VERSION}"
VIAddVersionKey "ProductVersion" "${VERSION}"
VIAddVersionKey "LegalCopyright" "The NEP Studio authors, MIT licence"

!define MUI_ICON "${ICON}"
!define MUI_UNICON "${ICON}"
!define MUI_FINISHPAGE_RUN "$INSTDIR\NEP Studio.exe"
!insertmacro MUI_PAGE_WELCOME
!insertmacro MUI_PAGE_DIRECTORY
!insertmacro MUI_PAGE_INSTFILES
!insertmacro MUI_PAGE_FINISH
!insertmacro MUI_UNPAGE_CONFIRM
!insertmacro MUI_UNPAGE_INSTFILES
!insertmacro MUI_LANGUAGE "English"
!insertmacro MUI_LANGUAGE "German"
!insertmacro MUI_LANGUAGE "Spanish"
!insertmacro MUI_LANGUAGE "French"
!insertmacro MUI_LANGUAGE "Italian"
!insertmacro MUI_LANGUAGE "Japanese"

Function .onInit
  ${IfNot} ${RunningX64}
    MessageBox MB_ICONSTOP "NEP Studio needs a 64-bit Windows." /SD IDOK
    Abort
  ${EndIf}
FunctionEnd

; The older version goes first, wherever it is: a file that the new one does not have must not stay.
; Only the folder that an installer of ours has noted is touched: others have an uninstall.exe, too.
Section "-Older version"
  ReadRegStr $1 HKCU "Software\${KEY}" "Folder"
  StrCmp $1 "" nothing_older
  IfFileExists "$1\uninstall.exe" 0 nothing_older
  StrCpy $0 "not started"
  ExecWait '"$1\uninstall.exe" /S _?=$1' $0
  StrCmp $0 "0" older_is_gone
    MessageBox MB_ICONSTOP "Close NEP Studio, then install it again." /SD IDOK
    SetErrorLevel 2
    Abort
  older_is_gone:
  Delete "$1\uninstall.exe" ; it could not take away itself
  RMDir "$1"
  nothing_older:
SectionEnd

Section "NEP Studio"
  SectionIn RO
  SetOutPath "$INSTDIR"
  File /r "${PROGRAM}\*"
  WriteUninstaller "$INSTDIR\uninstall.exe"

  CreateShortCut "$SMPROGRAMS\NEP Studio.lnk" "$INSTDIR\NEP Studio.exe"

  WriteRegStr HKCU "Software\${KEY}" "Folder" "$INSTDIR"
  WriteRegStr HKCU "Software\Classes\.nep\OpenWithProgids" "${KIND}" ""
  WriteRegStr HKCU "Software\Classes\.nep" "" "${KIND}"
  WriteRegStr HKCU "Software\Classes\.nep" "Content Type" "application/x-nep-studio-project"
  WriteRegStr HKCU "Software\Classes\${KIND}" "" "NEP Studio project"
  WriteRegStr HKCU "Software\Classes\${KIND}\DefaultIcon" "" "$INSTDIR\NEP Studio.exe,0"
  WriteRegStr HKCU "Software\Classes\${KIND}\shell\open\command" "" \
    '"$INSTDIR\NEP Studio.exe" "%1"'

  WriteRegStr HKCU "${UNINSTALL}" "DisplayName" "${TITLE}"
  WriteRegStr HKCU "${UNINSTALL}" "DisplayVersion" "${VERSION}"
  WriteRegStr HKCU "${UNINSTALL}" "DisplayIcon" "$INSTDIR\NEP Studio.exe"
  WriteRegStr HKCU "${UNINSTALL}" "Publisher" "The NEP Studio authors"
  WriteRegStr HKCU "${UNINSTALL}" "InstallLocation" "$INSTDIR"
  WriteRegStr HKCU "${UNINSTALL}" "UninstallString" '"$INSTDIR\uninstall.exe"'
  WriteRegStr HKCU "${UNINSTALL}" "QuietUninstallString" '"$INSTDIR\uninstall.exe" /S'
  WriteRegDWORD HKCU "${UNINSTALL}" "NoModify" 1
  WriteRegDWORD HKCU "${UNINSTALL}" "NoRepair" 1
  ${GetSize} "$INSTDIR" "/S=0K" $0 $1 $2
  WriteRegDWORD HKCU "${UNINSTALL}" "EstimatedSize" $0
  ${RefreshShellIcons}
SectionEnd

; A program that runs cannot be written to. Nothing is removed before all of them have ended.
!macro StopIfRunning FILE
  ClearErrors
  ${If} ${FileExists} "${FILE}"
    FileOpen $0 "${FILE}" a
    FileClose $0
  ${EndIf}
  ${If} ${Errors}
    MessageBox MB_ICONSTOP "NEP Studio is still open. Close it, then try again." /SD IDOK
    SetErrorLevel 2
    Abort
  ${EndIf}
!macroend

; Projects, settings and the folder of portable mode belong to the person and stay.
Section "Uninstall"
  !insertmacro StopIfRunning "$INSTDIR\NEP Studio.exe"
  !insertmacro StopIfRunning "$INSTDIR\nep-studio.exe"
  !insertmacro StopIfRunning "$INSTDIR\nep.exe"
  Delete "$INSTDIR\NEP Studio.exe"
  Delete "$INSTDIR\nep-studio.exe"
  Delete "$INSTDIR\nep.exe"
  RMDir /r "$INSTDIR\_internal"
  Delete "$INSTDIR\uninstall.exe"
  RMDir "$INSTDIR"
  Delete "$SMPROGRAMS\NEP Studio.lnk"

  DeleteRegValue HKCU "Software\Classes\.nep\OpenWithProgids" "${KIND}"
  ReadRegStr $0 HKCU "Software\Classes\.nep" ""
  StrCmp $0 "${KIND}" 0 others_nep
    DeleteRegValue HKCU "Software\Classes\.nep" ""
    DeleteRegValue HKCU "Software\Classes\.nep" "Content Type"
  others_nep:
  DeleteRegKey /ifempty HKCU "Software\Classes\.nep\OpenWithProgids"
  DeleteRegKey /ifempty HKCU "Software\Classes\.nep"
  DeleteRegKey HKCU "Software\Classes\${KIND}"
  DeleteRegKey HKCU "Software\${KEY}"
  DeleteRegKey HKCU "${UNINSTALL}"
  ${RefreshShellIcons}
SectionEnd
