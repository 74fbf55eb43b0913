# Installs rungc for this user and adds it to the search path; needs no administrator.
#   powershell -ExecutionPolicy Bypass -File install.ps1
#   powershell -ExecutionPolicy Bypass -File install.ps1 -Remove
param(
    # Folder of the executable.
    [string]$Folder = (Join-Path $env:LOCALAPPDATA "Programs\rungc"),
    # Removes what an installation has added.
    [switch]$Remove
)
$ErrorActionPreference = "Stop"

# Changes the user's search path. Read as it is stored: variables in it, such as %USERPROFILE%, stay.
function Set-SearchPath([scriptblock]$Change) {
    $key = [Microsoft.Win32.Registry]::CurrentUser.OpenSubKey("Environment", $true)
    $stored = [string]$key.GetValue("Path", "", "DoNotExpandEnvironmentNames")
    $others = @($stored.Split(";") | Where-Object { $_ -and $_ -ne $Folder })
    $key.SetValue("Path", ((& $Change $others) -join ";"), "ExpandString")
    $key.Close()
    # Informs other programs of the change.
    [Environment]::SetEnvironmentVariable("RUNGC_INSTALLED", $null, "User")
}

if ($Remove) {
    $executable = Join-Path $Folder "rungc.exe"
    if (Test-Path $executable) { Remove-Item $executable }
    if ((Test-Path $Folder) -and -not (Get-ChildItem $Folder)) { Remove-Item $Folder }
    Set-SearchPath { param($others) $others }
    Write-Output "Removed rungc from $Folder"
    return
}

New-Item -ItemType Directory -Force -Path $Folder | Out-Null
Copy-Item -Force (Join-Path $PSScriptRoot "rungc.exe") $Folder
Set-SearchPath { param($others) @($others) + $Folder }
& (Join-Path $Folder "rungc.exe") --version
Write-Output "Installed to $Folder. Open a new terminal and try: rungc demo"
